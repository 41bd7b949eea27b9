#include "servo/watchdog.h"

#include <pthread.h>

#include <algorithm>
#include <utility>

namespace dihaptic::servo {
namespace {

/// A servo that does not sleep would otherwise keep a thread of its own priority waiting for ever
/// where they share a processor. The servo's thread does it: the other might not come to run.
void raise_above_this(std::thread& thread) {
    int policy = 0;
    sched_param priority{};
    if (pthread_getschedparam(pthread_self(), &policy, &priority) != 0 || policy != SCHED_FIFO)
        return;
    ++priority.sched_priority;
    // refused: it watches as well as it can
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
    // false when the run ended first
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
    // a program that stood still as a whole goes on with this thread or with the servo's: that one
    // gets its time
    if (!no_tick_for(kStuck, Clock::now())) return;
    lock.unlock();
    stuck_();
}

}  // namespace dihaptic::servo
