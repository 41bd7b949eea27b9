#include "servo/watchdog.h"

#include <pthread.h>

#include <algorithm>
#include <utility>

namespace dihaptic::servo {
namespace {

/// Gives the watchdog a higher priority: otherwise, a servo that never sleeps would starve it on a
/// shared processor. The servo's thread sets the priority, because the watchdog's own thread might
/// never get to run.
void raise_above_this(std::thread& thread) {
    int policy = 0;
    sched_param priority{};
    if (pthread_getschedparam(pthread_self(), &policy, &priority) != 0 || policy != SCHED_FIFO)
        return;
    ++priority.sched_priority;
    // if this is refused, the watchdog runs without the higher priority
    pthread_setschedparam(thread.native_handle(), policy, &priority);
}

}  // namespace

Watchdog::Watchdog(Time limit, std::function<void()> stop, std::function<void()> stuck)
    : limit_(limit),
      stop_(std::move(stop)),
      stuck_(std::move(stuck)),
      last_end_(Clock::now().time_since_epoch().count()),
      thread_([this] { run(); }) {
    raise_above_this(thread_);
}

Watchdog::~Watchdog() {
    {
        const std::lock_guard lock(mutex_);
        done_ = true;
    }
    wake_.notify_all();
    thread_.join();
}

void Watchdog::run() {
    std::unique_lock lock(mutex_);
    // returns whether no tick ended for `limit`; false if the run ended first
    const auto no_tick_for = [&](Time limit, Clock::time_point from) {
        while (!done_) {
            const auto deadline = std::max(last_end(), from) + limit;
            if (Clock::now() >= deadline) return true;
            wake_.wait_until(lock, deadline);
        }
        return false;
    };
    if (!no_tick_for(limit_, Clock::time_point::min())) return;
    lock.unlock();
    stop_();
    lock.lock();
    // if the whole program was stopped, this thread may resume before the servo's thread, which
    // then needs some time
    if (!no_tick_for(kStuck, Clock::now())) return;
    lock.unlock();
    stuck_();
}

}  // namespace dihaptic::servo
