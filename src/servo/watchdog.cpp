#include "servo/watchdog.h"

#include <utility>

namespace dihaptic::servo {

Watchdog::Watchdog(Time limit, std::function<void()> stop, std::function<void()> stuck)
    : limit_(limit),
      stop_(std::move(stop)),
      stuck_(std::move(stuck)),
      last_end_(Clock::now().time_since_epoch().count()),
      thread_([this] { run(); }) {}

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
    const auto no_tick_for = [&](Time limit) {
        while (!done_) {
            const auto deadline = last_end() + limit;
            if (Clock::now() >= deadline) return true;
            wake_.wait_until(lock, deadline);
        }
        return false;
    };
    if (!no_tick_for(limit_)) return;
    lock.unlock();
    stop_();
    lock.lock();
    if (!no_tick_for(limit_ + kStuck)) return;
    lock.unlock();
    stuck_();
}

}  // namespace dihaptic::servo
