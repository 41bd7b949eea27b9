// Watchdog switches force off when the loop stalls. When a call to a device blocks, or the system
// keeps the servo's thread waiting, devices hold the last force until it is switched off. The
// watchdog has a thread of its own and calls only a stop function that may be called from any
// thread; it does not touch the servo's data.
//
// Started from the servo's thread, it gets that thread's priority plus one. It sleeps from deadline
// to deadline, without cost to the ticks.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "base/clock.h"

namespace dihaptic::servo {

class Watchdog {
  public:
    using Clock = std::chrono::steady_clock;
    /// A tick that has not ended this long after the stop is considered stuck.
    static constexpr Time kStuck = std::chrono::seconds(2);

    /// Calls `stop` once when no tick has ended for `limit`, and `stuck` once when none has ended
    /// for kStuck after that, both from the watchdog's thread. The time of the first tick counts
    /// from construction.
    Watchdog(Time limit, std::function<void()> stop, std::function<void()> stuck);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// Called from the servo's thread at the end of each tick. Neither waits nor allocates.
    void end_tick(Clock::time_point now) noexcept {
        last_end_.store(now.time_since_epoch().count(), std::memory_order_release);
    }

  private:
    void run();
    Clock::time_point last_end() const noexcept {
        return Clock::time_point(Clock::duration(last_end_.load(std::memory_order_acquire)));
    }

    Time limit_;
    std::function<void()> stop_;
    std::function<void()> stuck_;
    std::atomic<Clock::rep> last_end_;
    std::mutex mutex_;
    std::condition_variable wake_;
    bool done_ = false;
    std::thread thread_;
};

}  // namespace dihaptic::servo
