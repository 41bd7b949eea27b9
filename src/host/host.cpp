#include "host/host.h"

#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "host/force_off.h"
#include "host/messages.h"
#include "host/server.h"

namespace dihaptic::host {
namespace {

using nlohmann::json;

json fail(const std::string& what) {
    return to_json(Error(what, "Report this, with the session's folder."));
}

std::atomic<Server*> at_stake{nullptr};

/// Handles an error signal. Most likely the manufacturer's library failed. If it can no longer stop
/// the devices, only the devices' own guards remain.
void on_own_error(int signal) {
    constexpr itimerval kLastWait{{0, 0}, {0, 20'000}};
    std::signal(SIGALRM, SIG_DFL);
    setitimer(ITIMER_REAL, &kLastWait, nullptr);  // the library may hold a lock and never return
    if (Server* const server = at_stake.exchange(nullptr)) server->stop_at_death();
    std::signal(signal, SIG_DFL);
    raise(signal);
}

/// Answers the program's requests that come outside the ticks.
class Control {
  public:
    Control(SharedPage& page, const InRealTime& in_real_time)
        : page_(page), in_real_time_(in_real_time) {}
    ~Control() { at_stake.store(nullptr); }

    json answer(const json& message) {
        try {
            const std::string what = message.value("do", "");
            if (what == "make") return make(message);
            if (server_ == nullptr) return fail("the device host has no devices yet");
            if (what == "activate") server_->activate();
            if (what == "deactivate") server_->deactivate();
            if (what == "explain") return {{"said", server_->explain(message.at("device"))}};
            return {{"done", what}};
        } catch (const Error& e) {
            return to_json(e);
        } catch (const std::exception& e) {
            return fail(e.what());
        }
    }

  private:
    json make(const json& message) {
        const Order order = order_of(message);
        at_stake.store(nullptr);
        server_ = std::make_unique<Server>(page_, order, in_real_time_);
        at_stake.store(server_.get());
        return to_json(server_->devices());
    }

    SharedPage& page_;
    const InRealTime& in_real_time_;
    std::unique_ptr<Server> server_;
};

}  // namespace

int keep(const InRealTime& in_real_time) {
    void* const at =
        mmap(nullptr, sizeof(SharedPage), PROT_READ | PROT_WRITE, MAP_SHARED, kMemory, 0);
    if (at == MAP_FAILED) return EXIT_FAILURE;
    auto& page = *static_cast<SharedPage*>(at);
    // the device host ends with the program or the machine, but not when keys such as Ctrl-C are
    // pressed in the terminal
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGTSTP, SIGTTIN, SIGTTOU})
        std::signal(signal, SIG_IGN);
    for (const int signal : kErrors) std::signal(signal, on_own_error);
    Control control(page, in_real_time);
    while (const std::optional<json> message = receive(kSocket))
        send(kSocket, control.answer(*message));

    // the program has ended, so force is ended first; then the devices are shut down in an orderly
    // way, unless the manufacturer's library takes longer than kOrderly
    end_force(page);
    std::thread([] {
        constexpr auto kOrderly = std::chrono::seconds(1);
        std::this_thread::sleep_for(kOrderly);
        std::_Exit(EXIT_FAILURE);
    }).detach();
    control.answer({{"do", "deactivate"}});
    return EXIT_SUCCESS;
}

}  // namespace dihaptic::host
