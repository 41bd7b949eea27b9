#include "devices/haply/group.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <set>
#include <thread>

#include "devices/haply/connection.h"
#include "devices/haply/inventory.h"
#include "devices/haply/messages.h"
#include "devices/past.h"

namespace dihaptic::devices::haply {
namespace {

/// Number of readings from which the angular velocity is computed, because the service does not
/// report it for grips.
constexpr int kTurnWindow = 8;

std::optional<Grip> grip_of(const Options& options) {
    if (!options.wireless_verse_grip.empty())
        return Grip{GripKind::wireless_verse_grip, options.wireless_verse_grip};
    if (!options.verse_grip.empty()) return Grip{GripKind::verse_grip, options.verse_grip};
    return {};
}

std::vector<frame::DeviceInfo> infos(const std::vector<Wanted>& devices) {
    std::vector<frame::DeviceInfo> out;
    for (const Wanted& device : devices) {
        frame::DeviceInfo info;
        info.model = "Haply Inverse3";
        info.serial = device.options.device_id;
        info.peak_force = device.options.peak_force;
        info.measures_orientation = device.grip.has_value();
        out.push_back(info);
    }
    return out;
}

/// Reads the options of all devices, and checks that they are compatible with each other.
std::vector<Wanted> read_wanted(const std::vector<DeviceConfig>& configs,
                                Diagnostics& diagnostics) {
    std::vector<Wanted> devices;
    std::set<std::string> ids;
    for (const DeviceConfig& config : configs) {
        const Options options = read_options(config, diagnostics);
        devices.push_back({options, config.place, grip_of(options)});
        const Options& first = devices.front().options;
        if (!options.device_id.empty() && !ids.insert(options.device_id).second) {
            diagnostics.error(
                config.place, "device_id",
                fmt::format("'{}' is also another finger's device", options.device_id),
                "Give each finger a device of its own.");
        }
        if (options.url != first.url || options.time_out != first.time_out) {
            diagnostics.error(
                config.place, "url", "'url' or 'time_out' differs from another device's",
                "A single message of the service carries all fingers: give all devices "
                "the same values.");
        }
    }
    return devices;
}

std::vector<CommandWriter::Device> addressees(const std::vector<Wanted>& devices) {
    std::vector<CommandWriter::Device> out;
    out.reserve(devices.size());
    for (const Wanted& device : devices)
        out.push_back({device.options.device_id, device.options.force_key});
    return out;
}

class HaplyGroup final : public DeviceGroup {
  public:
    HaplyGroup(const std::vector<Wanted>& devices, Time tick)
        : DeviceGroup(infos(devices)),
          devices_(devices),
          url_(*Url::parse(devices.front().options.url)),
          time_out_(from_seconds(devices.front().options.time_out)),
          tick_(tick),
          reader_(Connection::kMostBytes),
          writer_(addressees(devices)),
          forces_D_(devices.size(), Vec3::Zero()),
          cycles_(devices.size()) {}
    ~HaplyGroup() override { deactivate(); }

    bool paces() const override { return true; }
    bool can_stop() const override { return true; }

  private:
    /// State of one device while the group is active.
    struct Cycle {
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
        check_inventory(message_, devices_);
        // sends a force of zero, to find out whether the service accepts commands before a hand
        // feels anything
        std::fill(forces_D_.begin(), forces_D_.end(), Vec3::Zero());
        connection_.send(writer_.write(forces_D_, true), kSetUpTime);
        receive_first(connection_, reader_, message_, "answer to a command");
        check_answer(message_, devices_);
        stopped_.store(false);
        unanswered_ = 0;
        fresh_ = true;
        sound_ = true;
        for (Cycle& cycle : cycles_) cycle.past = Past<Quat>(kTurnWindow);
    }

    void do_deactivate() override {
        std::fill(forces_D_.begin(), forces_D_.end(), Vec3::Zero());
        if (!stopped_.load()) connection_.send(writer_.write(forces_D_, false), time_out_);
        connection_.close();
    }

    /// Receives all outstanding answers; the last one contains the current state.
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
            Cycle& cycle = cycles_[i];
            if (!answers || !take(devices_[i], cycle, now)) {
                cycle.last.v_DH.setZero();
                cycle.last.w_DH.setZero();
                cycle.last.status = kNotAnswering;
            }
            readings[i] = cycle.last;
        }
    }

    /// Reads a device's state from the message. Returns false if the state is missing or
    /// incomplete, or if the device cannot be used.
    bool take(const Wanted& device, Cycle& cycle, Time now) const noexcept {
        const DeviceState* state = message_.device(device.options.device_id);
        if (state == nullptr || !state->p_DH || !state->v_DH) return false;
        if (state->power_supply == false || state->calibrated == false || state->ready == false)
            return false;
        Reading& reading = cycle.last;
        reading.status = 0;
        reading.p_DH = *state->p_DH;
        reading.v_DH = *state->v_DH;
        if (!device.grip) return true;
        const GripState* grip = message_.grip(device.grip->kind, device.grip->id);
        if (grip == nullptr || !grip->R) return false;
        reading.buttons = grip->buttons;
        reading.R_DH = *grip->R;
        const auto* old = cycle.past.exchange(now, reading.R_DH);
        reading.w_DH.setZero();
        if (old != nullptr && now > old->time) {
            reading.w_DH =
                rotation_vector(reading.R_DH * old->value.conjugate()) / seconds(now - old->time);
        }
        return true;
    }

    void do_write(std::span<const Wrench> wrenches_D) noexcept override {
        for (size_t i = 0; i < devices_.size(); ++i) forces_D_[i] = wrenches_D[i].force;
        send();
    }

    void do_pace(const std::function<bool()>& tick) override {
        receive();
        fresh_ = false;  // the answer may date from before the last pause
        while (true) {
            if (unanswered_ == 0) ask_without_force();
            receive();
            if (!tick()) return;
            if (!connection_.is_open()) std::this_thread::sleep_for(tick_);
        }
    }

    bool do_stop() noexcept override {
        stopped_.store(true);
        connection_.shut_down();
        return true;
    }

    std::vector<Wanted> devices_;
    Url url_;
    Time time_out_;
    Time tick_;
    Connection connection_;
    StateReader reader_;
    StateMessage message_;
    CommandWriter writer_;
    std::vector<Vec3> forces_D_;
    std::vector<Cycle> cycles_;
    int unanswered_ = 0;  // number of messages that have not been answered yet
    bool fresh_ = false;  // whether message_ has not been used by a read() yet
    bool sound_ = false;  // whether message_ is the last answer and is complete and free of errors
    std::atomic<bool> stopped_{false};
};

}  // namespace

std::vector<frame::DeviceInfo> describe_group(const std::vector<DeviceConfig>& configs,
                                              const Context&, Diagnostics& diagnostics) {
    return infos(read_wanted(configs, diagnostics));
}

std::unique_ptr<DeviceGroup> make_group(const std::vector<DeviceConfig>& configs,
                                        const Context& context) {
    Diagnostics diagnostics;
    const std::vector<Wanted> devices = read_wanted(configs, diagnostics);
    diagnostics.throw_if_errors();
    return std::make_unique<HaplyGroup>(devices, from_seconds(context.tick));
}

}  // namespace dihaptic::devices::haply
