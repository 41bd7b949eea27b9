#include "host/hosted_devices.h"

#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <thread>

#include "base/child.h"
#include "base/companion.h"
#include "base/unix_socket.h"
#include "host/force_off.h"
#include "host/host.h"
#include "host/messages.h"
#include "host/shared_page.h"

namespace dihaptic::host {
namespace {

using nlohmann::json;

/// A device host is given up once it has been silent for this much longer than the program is
/// allowed to be.
constexpr Time kPatience = std::chrono::milliseconds(20);
/// Time limit for making and activating devices, because opening and calibrating them is slow.
constexpr Time kSetUp = std::chrono::seconds(60);
/// Time limit for deactivating devices and ending their device host.
constexpr Time kSetDown = std::chrono::seconds(2);
/// Time limit for the first tick of devices that pace.
constexpr Time kBeginning = std::chrono::seconds(3);
/// Smallest time limit for each later tick of devices that pace, because the devices' own clock may
/// pause.
constexpr Time kSilence = std::chrono::milliseconds(200);
/// Time spent polling for an answer before sleeping. Most answers arrive sooner than a sleeping
/// thread would wake up.
constexpr Time kHope = std::chrono::microseconds(20);

/// The process of a device host, its socket, and the page shared with it.
class Process {
  public:
    explicit Process(const std::string& program) {
        auto [ours, its] = unix_socket_pair(SOCK_SEQPACKET);
        if (!ours) throw failure();
        socket_ = std::move(ours);
        const Descriptor memory(memfd_create("dihaptic device host", MFD_CLOEXEC));
        void* const at = memory && ftruncate(memory.get(), sizeof(SharedPage)) == 0
                             ? mmap(nullptr, sizeof(SharedPage), PROT_READ | PROT_WRITE, MAP_SHARED,
                                    memory.get(), 0)
                             : MAP_FAILED;
        if (at != MAP_FAILED) page_ = new (at) SharedPage;
        if (page_ != nullptr) start(program, its.get(), memory.get());
        if (child_.process() == 0) {
            const Error error = failure();
            end();
            throw error;
        }
    }
    ~Process() { end(); }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    SharedPage& page() { return *page_; }
    /// Whether the device host answers. Once an answer has failed to arrive, this remains false.
    bool answers() const { return answers_; }

    /// Sends a message and waits for the answer. Throws Error with the problems that the device
    /// host reports, or if no answer arrives within `most` or before `given_up` returns true.
    json ask(const json& message, Time most, const std::function<bool()>& given_up = {}) {
        std::optional<json> answer;
        if (answers_) {
            send(socket_.get(), message);
            answer = receive(socket_.get(), most, given_up);
        }
        // a late answer would be mistaken for the answer to the next message
        answers_ = answer.has_value();
        if (!answers_ && given_up && given_up()) {
            throw Error("interrupted while the program that owns the devices did not answer",
                        "Start again; if it never answers, switch the devices off and on first.");
        }
        if (!answers_) {
            throw Error("the program that owns the devices does not answer",
                        "Switch the devices off and on, and start again.");
        }
        if (answer->contains("problems")) throw error_of(*answer);
        return *std::move(answer);
    }

  private:
    static Error failure() {
        return {std::string("the program that owns the devices cannot be started: ") +
                    std::strerror(errno),
                "Close other programs, and start again."};
    }

    void start(const std::string& program, int socket, int memory) {
        static_assert(kSocket == 3 && kMemory == 4);
        constexpr int kKept = Launch::kKept;
        // keys pressed in the terminal do not reach the device host, and it does not inherit the
        // signals that this process blocks or ignores
        const int failed = child_.start({program,
                                         {},
                                         {kKept, kKept, kKept, socket, memory},
                                         POSIX_SPAWN_SETSID | Launch::kFreshSignals});
        if (failed != 0) errno = failed;
    }

    void end() {
        socket_.close();  // closing the socket ends the device host
        const int64_t begin = monotonic();
        while (!child_.has_ended()) {
            if (monotonic() - begin > kSetDown.count()) kill(child_.process(), SIGKILL);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        if (page_ != nullptr) munmap(page_, sizeof(SharedPage));
        page_ = nullptr;
    }

    Descriptor socket_;
    Child child_;
    SharedPage* page_ = nullptr;
    bool answers_ = true;
};

class HostedDevices final : public devices::DeviceGroup {
  public:
    HostedDevices(Order order, std::unique_ptr<Process> process, const json& made)
        : DeviceGroup(infos_of(made)),
          order_(std::move(order)),
          paces_(made.at("paces")),
          limit_(from_seconds(order_.hosting.longest_silence) + kPatience),
          process_(std::move(process)) {}
    ~HostedDevices() override { deactivate(); }

    bool paces() const override { return paces_; }
    bool can_stop() const override { return true; }

    std::string explain(int device) const override {
        if (lost_) return "The program that owns the devices does not answer.";
        try {
            return process_->ask({{"do", "explain"}, {"device", device}}, kSetDown)["said"];
        } catch (const Error&) {
            return "";
        }
    }

  private:
    void do_activate() override {
        if (process_ == nullptr || !process_->answers()) {
            // stored only once its devices have been made; otherwise the next attempt starts
            // another device host
            process_.reset();
            auto fresh = std::make_unique<Process>(order_.hosting.program);
            fresh->ask(to_json(order_), kSetUp, order_.hosting.given_up);
            process_ = std::move(fresh);
        }
        SharedPage& page = process_->page();
        page.ended.store(0);
        page.off.store(0);
        process_->ask({{"do", "activate"}}, kSetUp, order_.hosting.given_up);
        lost_ = false;
        watch_over(&page);
    }

    void do_deactivate() override {
        if (process_ == nullptr) return;
        forget(&process_->page());
        try {
            if (!lost_) process_->ask({{"do", "deactivate"}}, kSetDown);
        } catch (const Error&) {
            lost_ = true;
        }
        // the next activation starts another device host
        if (lost_) process_.reset();
    }

    /// Waits until the device host has answered all requests. Once a wait has taken longer than
    /// `most`, this always returns false.
    bool await_answer(Time most) noexcept {
        SharedPage& page = process_->page();
        const uint32_t wanted = page.asked.load();
        const int64_t begin = monotonic();
        for (uint32_t now = page.answered.load(std::memory_order_acquire); now != wanted && !lost_;
             now = page.answered.load(std::memory_order_acquire)) {
            const Time left = most - Time(monotonic() - begin);
            lost_ = !await_change(page.answered, now, left, kHope);
        }
        return !lost_;
    }

    /// Sends a request. Once the previous request has been answered, `fill` writes the request's
    /// data into the page.
    template <class Fill>
    bool ask(Request request, const Fill& fill) noexcept {
        if (lost_ || !await_answer(limit_)) return false;
        SharedPage& page = process_->page();
        fill(page);
        page.asked_at.store(monotonic(), std::memory_order_relaxed);
        page.request.store(request, std::memory_order_relaxed);
        page.asked.fetch_add(1, std::memory_order_release);
        advance(page.bell);
        return true;
    }

    void do_read(Time now, std::span<devices::Reading> readings) noexcept override {
        const bool answers =
            in_turn_ ? !lost_
                     : ask(Request::read, [now](SharedPage& page) { page.now = now.count(); }) &&
                           await_answer(limit_);
        for (size_t i = 0; i < readings.size(); ++i) {
            if (answers) readings[i] = process_->page().readings[i];
            if (!answers) readings[i].status = kNotAnswering;
        }
    }

    void do_write(std::span<const Wrench> wrenches_D) noexcept override {
        const auto fill = [wrenches_D](SharedPage& page) {
            std::copy(wrenches_D.begin(), wrenches_D.end(), page.wrenches);
        };
        if (!in_turn_) {
            ask(Request::write, fill);
        } else if (!lost_) {
            SharedPage& page = process_->page();
            fill(page);
            page.replied.fetch_add(1, std::memory_order_release);
            advance(page.bell);
        }
    }

    void do_pace(const std::function<bool()>& tick) override {
        if (!lost_) {
            SharedPage& page = process_->page();
            page.closing.store(0);
            const uint32_t before = page.offered.load();
            if (ask(Request::pace, [](SharedPage&) {}) && !take_turns(before, tick)) return;
        }
        lost_ = true;
        // for an orderly end, the servo keeps ticking and recording until it finds that no device
        // answers and ends the session
        while (tick()) std::this_thread::sleep_for(std::chrono::duration<double>(order_.tick));
    }

    /// Calls `tick` for each turn that the device host offers, until `tick` returns false. Returns
    /// true if the device host falls silent before that.
    bool take_turns(uint32_t seen, const std::function<bool()>& tick) {
        SharedPage& page = process_->page();
        Time most = kBeginning;
        while (await_change(page.offered, seen, most, kHope)) {
            most = std::max(kSilence, limit_);
            seen = page.offered.load();
            in_turn_ = true;
            const bool on = tick();
            in_turn_ = false;
            if (on) continue;
            page.closing.store(1);
            advance(page.bell);
            await_answer(kSetDown);
            return false;
        }
        return true;
    }

    bool do_stop() noexcept override {
        if (process_ == nullptr) return false;
        end_force(process_->page());
        return await_off(process_->page(), monotonic());
    }

    Order order_;
    bool paces_;
    Time limit_;
    std::unique_ptr<Process> process_;  // null if the device host was given up
    bool in_turn_ = false;              // whether the device host waits for a turn's forces
    bool lost_ = false;                 // whether the device host has stopped answering
};

}  // namespace

std::string program() {
    constexpr const char* kProgram = "dihaptic-host";
    std::string out = companion(kProgram);
    if (out.empty()) {
        throw Error(
            std::string("the program ") + kProgram + ", which owns real devices, is missing",
            kCompanionMissing);
    }
    return out;
}

std::unique_ptr<devices::DeviceGroup> host_devices(const Order& order) {
    auto process = std::make_unique<Process>(order.hosting.program);
    const json made = process->ask(to_json(order), kSetUp, order.hosting.given_up);
    return std::make_unique<HostedDevices>(order, std::move(process), made);
}

}  // namespace dihaptic::host
