#include "devices/haply/group.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <set>
#include <thread>

#include "devices/haply/connection.h"
#include "devices/haply/messages.h"
#include "devices/past.h"

namespace dihaptic::devices::haply {
namespace {

/// Connecting, and the first messages, which take longer.
constexpr Time kSetUpTime = std::chrono::seconds(2);
/// Readings that an angular velocity is taken over, as the service says none of grips.
constexpr int kTurnWindow = 8;

bool is_serial(const std::string& text) {
    return !text.empty() && text.size() <= 32 && std::all_of(text.begin(), text.end(), [](char c) {
        return std::isxdigit(static_cast<unsigned char>(c)) != 0;
    });
}

struct Grip {
    GripKind kind;
    std::string id;
};

std::optional<Grip> grip_of(const Options& options) {
    if (!options.wireless_verse_grip.empty())
        return Grip{GripKind::wireless_verse_grip, options.wireless_verse_grip};
    if (!options.verse_grip.empty()) return Grip{GripKind::verse_grip, options.verse_grip};
    return {};
}

/// Why a device can not be used as it is, and what to do; empty when it can.
std::pair<std::string, std::string> trouble(const DeviceState& state) {
    if (state.power_supply == false) return {"has no power", "Plug its power supply in."};
    if (state.calibrated == false) {
        return {"is not calibrated",
                "Put its cursor into the dock, or move it as the service asks, until its light "
                "stays on."};
    }
    if (state.ready == false) {
        return {"is not ready",
                "Wait until it has started, close other programs that use it, or unplug and plug "
                "it."};
    }
    return {};
}

/// An inventory, or the first answer to a command. Throws Error.
void receive_first(Connection& connection, StateReader& reader, StateMessage& message,
                   const char* what) {
    const std::string_view text = connection.receive(kSetUpTime);
    if (text.empty()) {
        throw Error(
            fmt::format("the Inverse Service gave no {} in {:g} s", what, seconds(kSetUpTime)),
            "Restart it (sudo systemctl restart haply-inverse-service); only versions "
            "from 3.1 on speak at port 10001.");
    }
    if (!reader.read(text, message)) {
        throw Error(fmt::format("the Inverse Service's {} is no whole JSON object", what),
                    "Correct url: another program may have the port; or restart the service (sudo "
                    "systemctl restart haply-inverse-service).");
    }
}

template <class States>
std::string list_ids(const States& states) {
    std::vector<std::string_view> ids;
    for (const auto& state : states) ids.push_back(state.id);
    return ids.empty() ? "none" : fmt::format("{}", fmt::join(ids, ", "));
}

std::vector<DeviceInfo> infos(const std::vector<Options>& options) {
    std::vector<DeviceInfo> out;
    for (const Options& option : options) {
        DeviceInfo info;
        info.model = "Haply Inverse3";
        info.peak_force = option.peak_force;
        info.measures_orientation = grip_of(option).has_value();
        out.push_back(info);
    }
    return out;
}

std::vector<CommandWriter::Device> addressees(const std::vector<Options>& options) {
    std::vector<CommandWriter::Device> out;
    for (const Options& option : options) out.push_back({option.device_id, option.force_key});
    return out;
}

class HaplyGroup final : public DeviceGroup {
  public:
    HaplyGroup(const std::vector<DeviceConfig>& configs, const std::vector<Options>& options,
               const Context& context)
        : DeviceGroup(infos(options)),
          url_(*Url::parse(options.front().url)),
          time_out_(from_seconds(options.front().time_out)),
          tick_(from_seconds(context.tick)),
          reader_(Connection::kMostBytes),
          writer_(addressees(options)),
          forces_D_(options.size(), Vec3::Zero()) {
        for (size_t i = 0; i < options.size(); ++i)
            devices_.push_back({options[i], configs[i].place, grip_of(options[i])});
    }
    ~HaplyGroup() override { deactivate(); }

    bool paces() const override { return true; }
    bool can_stop() const override { return true; }

  private:
    struct Device {
        Options options;
        Place place;
        std::optional<Grip> grip;
        bool clamped = false;
        Reading last{};
        Past<Quat> past{kTurnWindow};
    };

    void do_activate() override {
        try {
            connect();
        } catch (const Error&) {
            connection_.close();
            throw;
        }
    }

    void connect() {
        connection_.open(url_, kSetUpTime);
        receive_first(connection_, reader_, message_, "list of devices");
        check_inventory();
        // no force yet: what the service thinks of our messages is known before a hand feels any
        std::fill(forces_D_.begin(), forces_D_.end(), Vec3::Zero());
        connection_.send(writer_.write(forces_D_, true), kSetUpTime);
        receive_first(connection_, reader_, message_, "answer to a command");
        check_answer();
        stopped_.store(false);
        unanswered_ = 0;
        fresh_ = true;
        sound_ = true;
        for (Device& device : devices_) {
            device.past = Past<Quat>(kTurnWindow);
            device.clamped = false;
        }
    }

    void check_inventory() const {
        Diagnostics diagnostics;
        for (const Device& device : devices_) {
            const std::string& id = device.options.device_id;
            const auto same =
                std::count_if(message_.devices().begin(), message_.devices().end(),
                              [&](const DeviceState& state) { return state.id == id; });
            if (same == 0) {
                diagnostics.error(
                    device.place, "device_id",
                    fmt::format("the Inverse Service knows no Inverse3 '{}'", id),
                    fmt::format("It lists: {}. Plug the device in, or correct the serial number.",
                                list_ids(message_.devices())));
            } else if (same > 1) {
                diagnostics.error(
                    device.place, "device_id",
                    fmt::format("the Inverse Service lists {} devices '{}'", same, id),
                    "Unplug one: which of them a force goes to cannot be said. Then ask Haply for "
                    "another serial number.");
            } else if (const auto [what, remedy] = trouble(*message_.device(id)); !what.empty()) {
                diagnostics.error(device.place, "device_id",
                                  fmt::format("the Inverse3 '{}' {}", id, what), remedy);
            }
            if (device.grip && message_.grip(device.grip->kind, device.grip->id) == nullptr) {
                diagnostics.error(
                    device.place, std::string(enum_name(device.grip->kind)),
                    fmt::format("the Inverse Service knows no such grip '{}', or several",
                                device.grip->id),
                    fmt::format("It lists: {}. Switch the grip on and pair it, or correct the "
                                "serial number.",
                                list_ids(message_.grips())));
            }
        }
        diagnostics.throw_if_errors();
    }

    void check_answer() const {
        for (const Device& device : devices_) {
            if (message_.error.empty() && message_.device(device.options.device_id) != nullptr)
                continue;
            const ForceKey key = device.options.force_key;
            throw Error(
                device.place, "force_key",
                message_.error.empty()
                    ? fmt::format("the Inverse Service's answer to a command leaves '{}' out",
                                  device.options.device_id)
                    : fmt::format("the Inverse Service refuses a command: {}", message_.error),
                fmt::format(
                    "Its versions spell the force differently: try force_key: {}.",
                    enum_name(key == ForceKey::vector ? ForceKey::values : ForceKey::vector)));
        }
    }

    void do_deactivate() override {
        std::fill(forces_D_.begin(), forces_D_.end(), Vec3::Zero());
        if (!stopped_.load()) connection_.send(writer_.write(forces_D_, false), time_out_);
        connection_.close();
    }

    /// Takes every answer that is due; the last is the state.
    void receive() noexcept {
        for (; unanswered_ > 0; --unanswered_) {
            const std::string_view text = connection_.receive(time_out_);
            sound_ = !text.empty() && reader_.read(text, message_) && message_.error.empty();
            if (!connection_.is_open()) {
                unanswered_ = 0;
                break;
            }
        }
        fresh_ = true;
    }

    void send() noexcept {
        if (stopped_.load(std::memory_order_relaxed)) {
            for (Vec3& force : forces_D_) force.setZero();
        }
        if (connection_.send(writer_.write(forces_D_, false), time_out_)) ++unanswered_;
    }

    void ask_without_force() noexcept {
        for (Vec3& force : forces_D_) force.setZero();
        send();
    }

    void do_read(Time now, std::span<Reading> readings) noexcept override {
        if (!fresh_) {
            if (unanswered_ == 0) ask_without_force();
            receive();
        }
        fresh_ = false;
        const bool answers = connection_.is_open() && sound_;
        for (size_t i = 0; i < devices_.size(); ++i) {
            Device& device = devices_[i];
            if (!answers || !take(device, now)) {
                device.last.v_DH.setZero();
                device.last.w_DH.setZero();
                device.last.status = kNotAnswering;
            }
            readings[i] = device.last;
            if (device.clamped) readings[i].status |= kForceClamped;
        }
    }

    /// What the message says of a device; false when it says too little.
    bool take(Device& device, Time now) const noexcept {
        const DeviceState* state = message_.device(device.options.device_id);
        if (state == nullptr || !state->p_DH || !state->v_DH) return false;
        if (state->power_supply == false || state->calibrated == false || state->ready == false)
            return false;
        Reading& reading = device.last;
        reading.status = 0;
        reading.p_DH = *state->p_DH;
        reading.v_DH = *state->v_DH;
        if (!device.grip) return true;
        const GripState* grip = message_.grip(device.grip->kind, device.grip->id);
        if (grip == nullptr || !grip->R) return false;
        reading.buttons = grip->buttons;
        reading.R_DH = *grip->R;
        const auto* old = device.past.exchange(now, reading.R_DH);
        reading.w_DH.setZero();
        if (old != nullptr && now > old->time) {
            reading.w_DH =
                rotation_vector(reading.R_DH * old->value.conjugate()) / seconds(now - old->time);
        }
        return true;
    }

    void do_write(std::span<const Wrench> wrenches_D) noexcept override {
        for (size_t i = 0; i < devices_.size(); ++i) {
            Vec3& force = forces_D_[i];
            force = wrenches_D[i].force;
            const double size = force.norm();
            const double most = devices_[i].options.peak_force;
            devices_[i].clamped = size > most;
            if (size > most) force *= most / size;
            if (!force.allFinite()) force.setZero();
        }
        send();
    }

    void do_pace(const std::function<bool()>& tick) override {
        receive();
        fresh_ = false;  // it may be as old as the pause before
        while (true) {
            if (unanswered_ == 0) ask_without_force();
            receive();
            if (!tick()) return;
            if (!connection_.is_open()) std::this_thread::sleep_for(tick_);
        }
    }

    void do_stop() noexcept override {
        stopped_.store(true);
        connection_.shut_down();
    }

    Url url_;
    Time time_out_;
    Time tick_;
    std::vector<Device> devices_;
    Connection connection_;
    StateReader reader_;
    StateMessage message_;
    CommandWriter writer_;
    std::vector<Vec3> forces_D_;
    int unanswered_ = 0;  // messages that the service owes an answer to
    bool fresh_ = false;  // message_ was not read yet
    bool sound_ = false;  // message_ is what the service last said
    std::atomic<bool> stopped_{false};
};

}  // namespace

Options read_options(const DeviceConfig& config, Diagnostics& diagnostics) {
    Options options;
    Node given = config.options;
    if (given.kind == Node::Kind::null) {
        given = Node::mapping();
        given.place = config.place;
    }
    read_fields(options, given, diagnostics);
    const auto expect_serial = [&](const char* key, const std::string& text) {
        if (text.empty() || is_serial(text)) return;
        diagnostics.error(given.place, key, fmt::format("'{}' is no serial number", text),
                          "It is hexadecimal, as `dihaptic devices` lists it, e.g. 049D.");
    };
    expect_serial("device_id", options.device_id);
    expect_serial("verse_grip", options.verse_grip);
    expect_serial("wireless_verse_grip", options.wireless_verse_grip);
    if (!options.verse_grip.empty() && !options.wireless_verse_grip.empty()) {
        diagnostics.error(given.place, "verse_grip", "there is a wireless_verse_grip too",
                          "A finger's orientation comes from one grip: leave one out.");
    }
    if (!Url::parse(options.url)) {
        diagnostics.error(given.place, "url",
                          fmt::format("'{}' is no address of a service", options.url),
                          "It is like ws://localhost:10001/.");
    }
    return options;
}

std::unique_ptr<DeviceGroup> make_group(const std::vector<DeviceConfig>& configs,
                                        const Context& context) {
    Diagnostics diagnostics;
    std::vector<Options> options;
    std::set<std::string> ids;
    for (const DeviceConfig& config : configs) {
        options.push_back(read_options(config, diagnostics));
        const Options& option = options.back();
        if (!option.device_id.empty() && !ids.insert(option.device_id).second) {
            diagnostics.error(config.place, "device_id",
                              fmt::format("'{}' is another finger's device too", option.device_id),
                              "Give each finger a device of its own.");
        }
        if (option.url != options.front().url || option.time_out != options.front().time_out) {
            diagnostics.error(config.place, "url", "url or time_out differ from another device's",
                              "One message of one service carries all fingers: give all devices "
                              "the same.");
        }
    }
    diagnostics.throw_if_errors();
    return std::make_unique<HaplyGroup>(configs, options, context);
}

Survey survey_of(const std::string& url) {
    Survey survey;
    try {
        Connection connection;
        StateReader reader(Connection::kMostBytes);
        StateMessage message;
        connection.open(Url::parse(url).value(), kSetUpTime);
        receive_first(connection, reader, message, "list of devices");
        for (const DeviceState& state : message.devices()) {
            const auto [what, remedy] = trouble(state);
            survey.devices.push_back(
                {std::string(state.id), "Haply Inverse3",
                 what.empty() ? "ready" : fmt::format("{}: {}", what, remedy)});
        }
        for (const GripState& state : message.grips())
            survey.devices.push_back(
                {std::string(state.id), std::string(enum_name(state.kind)), "ready"});
        if (message.devices().empty()) {
            survey.missing = fmt::format(
                "the Inverse Service at {} lists no Inverse3. Plug one in, with its power supply.",
                url);
        }
    } catch (const Error& e) {
        const Problem& problem = e.problems().front();
        survey.missing = problem.what + ". " + problem.remedy;
    }
    return survey;
}

}  // namespace dihaptic::devices::haply
