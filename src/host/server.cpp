#include "host/server.h"

#include <algorithm>
#include <latch>

namespace dihaptic::host {
namespace {

/// Time between two checks by the watcher if nothing wakes it.
constexpr Time kLook = std::chrono::milliseconds(5);
/// Time that the serving thread is given to switch force off before the watcher does so.
constexpr Time kOwnWay = std::chrono::milliseconds(1);
/// Interval at which an idle serving thread wakes up.
constexpr Time kIdle = std::chrono::seconds(1);

}  // namespace

Server::Server(SharedPage& page, const Order& order, const InRealTime& in_real_time)
    : page_(page),
      in_real_time_(in_real_time),
      longest_silence_(from_seconds(order.hosting.longest_silence)),
      tick_(from_seconds(order.tick)),
      priority_(order.hosting.priority),
      backend_(order.backend) {
    for (const devices::DeviceConfig& config : order.configs) places_.push_back(config.place);
    const devices::Backend* const backend = devices::find_backend(order.backend);
    if (backend == nullptr || order.configs.empty() || order.configs.size() > kMostDevices) {
        throw Error("a rig has one to eight real devices, all with the same backend",
                    "Correct the rig file.");
    }
    devices::Context context;
    context.tick = order.tick;
    devices_ = backend->make(order.configs, context);
    readings_.resize(order.configs.size());
    wrenches_.resize(order.configs.size());
}

Server::~Server() {
    deactivate();
}

void Server::activate() {
    deactivate();
    std::vector<devices::DeviceClaim> claims = devices::claim_devices(backend_, *devices_, places_);
    devices_->activate();
    claims_ = std::move(claims);
    holding_ = behind_ = false;
    busy_since_.store(0);
    page_.answered.store(page_.asked.load());
    watching_.store(true);
    // setting up real-time scheduling takes longer than a tick, so activation waits for both
    // threads
    std::latch ready(3);
    const auto begin = [&](int priority, void (Server::*work)() noexcept) {
        return std::thread([this, priority, work, &ready] {
            in_real_time_(priority, [&] {
                ready.count_down();
                (this->*work)();
            });
        });
    };
    serving_ = begin(priority_, &Server::serve_all);
    watcher_ = begin(priority_ + 1, &Server::watch);
    ready.arrive_and_wait();
}

void Server::deactivate() {
    if (serving_.joinable()) {
        page_.closing.store(1);
        page_.request.store(Request::quit, std::memory_order_relaxed);
        page_.asked.fetch_add(1);
        advance(page_.bell);
        serving_.join();
    }
    watching_.store(false);
    if (watcher_.joinable()) {
        wake(page_.ended);
        watcher_.join();
    }
    devices_->deactivate();
    claims_.clear();
}

void Server::serve_all() noexcept {
    uint32_t served = page_.answered.load();
    int64_t heard = monotonic();
    while (true) {
        const uint32_t bell = page_.bell.load(std::memory_order_acquire);
        if (ended()) take_force_away();
        if (page_.asked.load(std::memory_order_acquire) == served) {
            // a force is held for at most longest_silence_ after the last request
            const Time left = longest_silence_ - Time(monotonic() - heard);
            if (holding_ && left <= Time(0)) write_zero();
            wait_on(page_.bell, bell, holding_ ? left : kIdle);
            continue;
        }
        // a device host that was stopped finds requests that were made in the meantime
        heard = page_.asked_at.load(std::memory_order_relaxed);
        const Request request = page_.request.load(std::memory_order_relaxed);
        if (request == Request::quit) return;
        serve(request);
        ++served;
        page_.answered.store(served, std::memory_order_release);
        wake(page_.answered);
    }
}

void Server::serve(Request request) noexcept {
    if (request == Request::read) read(Time(page_.now));
    if (request == Request::write) overslept_since(page_.asked_at.load()) ? write_zero() : write();
    if (request == Request::pace) {
        replied_ = page_.replied.load();
        turn_time_ = Time(0);
        behind_ = false;
        turned_ = monotonic();
        devices_->pace([this] { return take_turn(); });
        holding_ = false;
    }
}

/// A call to the devices. While this object exists, the watcher checks how long the call has taken.
class Server::Call {
  public:
    explicit Call(Server& server) : server_(server) { server_.busy_since_.store(monotonic()); }
    ~Call() { server_.busy_since_.store(0); }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

  private:
    Server& server_;
};

void Server::read(Time now) noexcept {
    const Call call(*this);
    devices_->read(now, readings_);
    std::copy(readings_.begin(), readings_.end(), page_.readings);
}

void Server::write() noexcept {
    if (ended()) return write_zero();
    std::copy_n(page_.wrenches, wrenches_.size(), wrenches_.begin());
    const bool some = std::any_of(wrenches_.begin(), wrenches_.end(),
                                  [](const Wrench& wrench) { return !wrench.is_zero(); });
    holding_ = holding_ || some;  // during the call, either the old or the new force may act
    const Call call(*this);
    devices_->write(wrenches_);
    holding_ = some;
}

void Server::write_zero() noexcept {
    std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
    const Call call(*this);
    devices_->write(wrenches_);
    holding_ = false;
}

void Server::take_force_away() noexcept {
    if (page_.off.load() != 0) return;
    write_zero();
    switch_off();
}

/// Switches force off. For devices without stop(), writing zero is the only way, so nothing more is
/// done for them.
void Server::switch_off() noexcept {
    if (!devices_->can_stop() || devices_->stop()) page_.off.store(1);
}

/// Waits for the program's forces. Returns whether they came in time.
bool Server::await_reply() noexcept {
    // after a missed turn, the program gets only one tick per turn rather than the entire longest
    // silence
    const Time most = behind_ ? tick_ : longest_silence_;
    const int64_t begin = monotonic();
    while (!ended() && page_.closing.load() == 0) {
        const uint32_t bell = page_.bell.load(std::memory_order_acquire);
        if (page_.replied.load(std::memory_order_acquire) != replied_) return true;
        const Time left = most - Time(monotonic() - begin);
        if (left <= Time(0) || ended()) return false;
        wait_on(page_.bell, bell, left);
    }
    return false;
}

/// Runs one tick of devices that pace; the program computes the forces between reading and writing.
bool Server::take_turn() noexcept {
    const bool overslept = holding_ && overslept_since(turned_);
    const int64_t begin = monotonic();
    read(turn_time_);
    turn_time_ += tick_;
    if (overslept) {
        behind_ = true;
        return end_turn(false);
    }
    replied_ = page_.replied.load(std::memory_order_acquire);
    if (page_.closing.load() == 0) advance(page_.offered);
    const bool replied = await_reply() && !overslept_since(begin);
    behind_ = !replied;
    return end_turn(replied);
}

/// Whether this process has been stopped since `time`, or has not got the processor; the acting
/// force is then older than allowed.
bool Server::overslept_since(int64_t time) const noexcept {
    return monotonic() - time > longest_silence_.count();
}

/// Writes the forces of the program's reply, or zero. Returns whether another turn may follow.
bool Server::end_turn(bool replied) noexcept {
    if (replied && !ended()) {
        write();
    } else {
        write_zero();
        if (ended()) switch_off();
    }
    turned_ = monotonic();
    return page_.closing.load() == 0;
}

/// Stops the devices when the program has ended force, or when a call to the manufacturer's library
/// hangs and blocks the serving thread.
void Server::watch() noexcept {
    bool stopped = false;
    while (watching_.load()) {
        wait_on(page_.ended, 0, kLook);
        const int64_t busy = busy_since_.load();
        const bool hangs = holding_ && busy != 0 && monotonic() - busy > longest_silence_.count();
        const bool wanted = ended() || hangs;
        if (wanted && !stopped) {
            if (ended()) std::this_thread::sleep_for(kOwnWay);
            if (page_.off.load() == 0 && devices_->can_stop()) switch_off();
        } else if (ended()) {
            std::this_thread::sleep_for(kLook);
        }
        stopped = wanted;
    }
}

}  // namespace dihaptic::host
