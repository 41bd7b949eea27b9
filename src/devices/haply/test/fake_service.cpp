#include "devices/haply/test/fake_service.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "devices/test/felt_outside.h"

namespace dihaptic::devices::haply {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using beast::error_code;
using Stream = websocket::stream<net::ip::tcp::socket>;

std::string vector_text(const Vec3& v) {
    return fmt::format(R"({{"x":{},"y":{},"z":{}}})", v.x(), v.y(), v.z());
}

Vec3 vector_of(const nlohmann::json& json) {
    return {json.value("x", 0.0), json.value("y", 0.0), json.value("z", 0.0)};
}

}  // namespace

struct FakeService::Impl {
    struct Session {
        explicit Session(net::ip::tcp::socket socket) : stream(std::move(socket)) {}
        Stream stream;
        beast::flat_buffer buffer;
        std::deque<std::string> out;
        int messages = 0;
        bool mute = false;
    };

    Impl(Setup setup_in, const Context& context)
        : setup(std::move(setup_in)),
          plant(setup.hand ? nullptr : find_backend("simulated")->make(setup.devices, context)),
          period(from_seconds(setup.rate > 0 ? 1 / setup.rate : context.tick)),
          readings(setup.devices.size()),
          forces(setup.devices.size()) {
        setup.ids.resize(std::max(setup.ids.size(), setup.devices.size()));
        if (plant) plant->activate();
        acceptor.set_option(net::ip::tcp::acceptor::reuse_address(true));
        accept();
        if (setup.rate > 0) {
            timer.expires_at(std::chrono::steady_clock::now() + period);
            wait_for_tick();
        }
        thread = std::thread([this] { io.run(); });
    }
    ~Impl() {
        io.stop();
        thread.join();
    }

    void accept() {
        acceptor.async_accept([this](error_code ec, net::ip::tcp::socket socket) {
            if (ec) return;
            socket.set_option(net::ip::tcp::no_delay(true));
            greet(std::move(socket));
            accept();
        });
    }

    void greet(net::ip::tcp::socket socket) {
        error_code ec;
        if (setup.garbage) {
            net::write(socket, net::buffer("SSH-2.0-OpenSSH_9.2p1\r\n\r\n", 25), ec);
            return;
        }
        beast::flat_buffer buffer;
        http::request<http::string_body> request;
        http::read(socket, buffer, request, ec);
        if (ec) return;
        if (setup.refuses_http || !websocket::is_upgrade(request)) {
            const http::response<http::empty_body> refusal(http::status::not_found,
                                                           request.version());
            http::serializer<false, http::empty_body> serializer(refusal);
            http::write(socket, serializer, ec);
            return;
        }
        session = std::make_shared<Session>(std::move(socket));
        session->stream.accept(request, ec);
        if (ec) return;
        session->stream.text(true);
        time = Time(0);
        commanded = false;
        owed = 0;
        for (Wrench& force : forces) force = {};
        if (plant) {
            plant->deactivate();
            plant->activate();
        }
        read();
        send(session, setup.greeting.empty() ? state_text(true) : setup.greeting);
        listen(session);
    }

    void listen(const std::shared_ptr<Session>& each) {
        each->stream.async_read(each->buffer, [this, each](error_code ec, size_t) {
            if (ec || each != session) return;
            const std::string text = beast::buffers_to_string(each->buffer.data());
            each->buffer.consume(each->buffer.size());
            take(text);
            listen(each);
        });
    }

    void send(const std::shared_ptr<Session>& to, std::string text) {
        to->out.push_back(std::move(text));
        if (to->out.size() == 1) send_next(to);
    }
    void send_next(const std::shared_ptr<Session>& to) {
        to->stream.async_write(net::buffer(to->out.front()), [this, to](error_code ec, size_t) {
            if (ec) return;
            to->out.pop_front();
            if (!to->out.empty()) send_next(to);
        });
    }

    /// Processes a message from the client.
    void take(const std::string& text) {
        const auto json = nlohmann::json::parse(text);
        Forces these(setup.devices.size(), Vec3::Zero());
        for (const auto& device : json.value("inverse3", nlohmann::json::array())) {
            const auto found = std::find(setup.ids.begin(), setup.ids.end(),
                                         device.at("device_id").get<std::string>());
            const auto index = static_cast<size_t>(found - setup.ids.begin());
            const auto& command = device.at("commands").at("set_cursor_force");
            for (const char* key : {"vector", "values"}) {
                if (!command.contains(key)) continue;
                if (key == setup.refused_key) {
                    ++session->messages;
                    send(session, fmt::format(R"({{"error":"unknown field '{}'"}})", key));
                    return;
                }
                if (index < these.size()) these[index] = vector_of(command.at(key));
            }
        }
        {
            const std::lock_guard lock(mutex);
            received.push_back(these);
        }
        for (size_t i = 0; i < these.size(); ++i) forces[i] = {these[i], Vec3::Zero()};
        commanded = true;
        ++owed;
        if (setup.rate > 0) return;
        // time starts with the first message, so that a session's first tick has the state at time
        // 0
        if (session->messages > 0) tick();
        answer();
    }

    void wait_for_tick() {
        timer.async_wait([this](error_code ec) {
            if (ec) return;
            tick();
            for (; owed > 0; --owed) answer();
            timer.expires_at(std::max(timer.expiry() + period, std::chrono::steady_clock::now()));
            wait_for_tick();
        });
    }

    /// Advances the devices by one period.
    void tick() {
        if (!commanded) {
            for (Wrench& force : forces) force = {};
        }
        for (size_t i = 0; i < forces.size(); ++i) outside.show(i, forces[i].force, commanded);
        commanded = false;
        if (plant) plant->write(forces);
        time += period;
        read();
        const std::lock_guard lock(mutex);
        felt.emplace_back();
        for (const Wrench& force : forces) felt.back().push_back(force.force);
    }

    void read() {
        if (plant) return plant->read(time, readings);
        for (size_t i = 0; i < readings.size(); ++i) {
            const Held held = setup.hand(i, seconds(time), forces[i]);
            readings[i].p_DH = held.p;
            readings[i].v_DH = held.v;
            readings[i].R_DH = held.R;
            readings[i].w_DH = held.w;
        }
    }

    void answer() {
        const int message = session->messages++;
        Time pause{0};
        bool half = false;
        {
            const std::lock_guard lock(mutex);
            if (planned != Mischief::none && message == planned_message) {
                mischief = std::exchange(planned, Mischief::none);
                mischief_tick = static_cast<int>(felt.size()) - 1;
                if (mischief == Mischief::late) pause = planned_pause;
                if (mischief == Mischief::silent) session->mute = true;
                half = mischief == Mischief::half_message;
                if (mischief == Mischief::closes) {
                    mischief = Mischief::none;
                    session->stream.next_layer().close();
                    return;
                }
            }
        }
        std::string text = state_text(message % 100 == 7);
        if (mischief == Mischief::half_json) text.resize(text.size() / 2);
        if (mischief == Mischief::complains) text = R"({"error":"device-safety-triggered"})";
        if (half) {
            // the header of a complete text frame, unmasked like every frame sent by a server
            const std::string head{'\x81', '\x7e', static_cast<char>(text.size() >> 8),
                                   static_cast<char>(text.size() & 0xff)};
            error_code ec;
            net::write(session->stream.next_layer(),
                       net::buffer(head + text.substr(0, text.size() / 2)), ec);
            session->mute = true;
        }
        if (session->mute) return;
        if (pause == Time(0)) {
            send(session, std::move(text));
            return;
        }
        auto later = std::make_shared<net::steady_timer>(io, pause);
        later->async_wait([this, later, to = session, text = std::move(text)](error_code) mutable {
            send(to, std::move(text));
        });
    }

    std::string state_text(bool full) const {
        std::vector<std::string> devices;
        std::vector<std::string> grips;
        for (size_t i = 0; i < readings.size(); ++i) {
            const bool odd_one = i == mischief_device;
            if (mischief == Mischief::leaves_out && odd_one) continue;
            std::string position = vector_text(readings[i].p_DH);
            if (mischief == Mischief::not_a_number && odd_one)
                position = R"({"x":0.1,"y":NaN,"z":0})";
            const std::string& id = setup.ids[i];
            const bool uncalibrated =
                (mischief == Mischief::loses_calibration && odd_one) || id == setup.not_calibrated;
            std::string config;
            std::string status;
            if (full) {
                config = R"("config":{"device_info":{"id":7,"version":[1,2]},"handedness":"right",)"
                         R"("preset":"defaults","filters":{}},)";
            }
            if (full || uncalibrated) {
                status =
                    fmt::format(R"(,"status":{{"calibrated":{},"in_use":false,"power_supply":{},)"
                                R"("ready":{},"started":true}})",
                                !uncalibrated, id != setup.no_power, id != setup.not_ready);
            }
            devices.push_back(fmt::format(
                R"({{"device_id":"{}",{}"state":{{"cursor_position":{},"cursor_velocity":{},)"
                R"("current_cursor_force":{},"angular_position":{{"a0":1.5,"a1":-2,"a2":3e1}},)"
                R"("control_mode":"cursor_force"}}{}}})",
                id, config, position, vector_text(readings[i].v_DH), vector_text(forces[i].force),
                status));
            if (!setup.grips) continue;
            const Quat& R = readings[i].R_DH;
            grips.push_back(fmt::format(
                R"({{"device_id":"A{}","state":{{"orientation":{{"x":{},"y":{},"z":{},"w":{}}},)"
                R"("buttons":{{"a":{},"b":false,"c":{}}},"battery_level":0.5}}}})",
                i, R.x(), R.y(), R.z(), R.w(), (readings[i].buttons & 1) != 0,
                (readings[i].buttons & 4) != 0));
        }
        return fmt::format(
            R"({{"session_id":"00000001","inverse3":[{}],"wireless_verse_grip":[{}]}})",
            fmt::join(devices, ","), fmt::join(grips, ","));
    }

    Setup setup;
    std::unique_ptr<DeviceGroup> plant;  // null if a hand moves the handles
    FeltOutside outside;
    Time period;
    Time time{0};
    std::vector<Reading> readings;
    std::vector<Wrench> forces;
    bool commanded = false;  // whether a message has arrived in this tick
    int owed = 0;            // number of answers that have not been sent yet

    net::io_context io{1};
    net::ip::tcp::acceptor acceptor{io, {net::ip::make_address("127.0.0.1"), 0}};
    net::steady_timer timer{io};
    std::shared_ptr<Session> session;
    Mischief mischief = Mischief::none;  // present misbehaviour
    size_t mischief_device = 0;

    mutable std::mutex mutex;  // protects the members below
    Mischief planned = Mischief::none;
    int planned_message = -1;
    Time planned_pause{0};
    int mischief_tick = -1;
    std::vector<Forces> received;
    std::vector<Forces> felt;

    std::thread thread;
};

FakeService::FakeService(const Setup& setup, const Context& context)
    : impl_(std::make_unique<Impl>(setup, context)) {}

FakeService::~FakeService() = default;

std::string FakeService::url() const {
    return fmt::format("ws://127.0.0.1:{}/", impl_->acceptor.local_endpoint().port());
}

Node FakeService::options(size_t device, const std::string& more) const {
    return parse_yaml(
        fmt::format("{{ {}device_id: {}, url: '{}' }}", more, impl_->setup.ids[device], url()),
        "rig.yaml");
}

void FakeService::misbehave(Mischief what, int message, size_t device, Time pause) {
    const std::lock_guard lock(impl_->mutex);
    impl_->planned = what;
    impl_->planned_message = message;
    impl_->mischief_device = device;
    impl_->planned_pause = pause;
}

std::vector<FakeService::Forces> FakeService::received() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->received;
}

std::vector<FakeService::Forces> FakeService::felt() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->felt;
}

int FakeService::mischief_tick() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->mischief_tick;
}

std::vector<DeviceConfig> rig_of(const FakeService& service,
                                 const std::vector<DeviceConfig>& simulated,
                                 const std::string& more) {
    std::vector<DeviceConfig> out = simulated;
    for (size_t i = 0; i < out.size(); ++i) out[i].options = service.options(i, more);
    return out;
}

}  // namespace dihaptic::devices::haply
