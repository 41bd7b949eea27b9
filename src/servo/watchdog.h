// Watchdog switches force off when the loop stalls. If a call to a device blocks, or if the system
// does not run the servo's thread, the devices hold the last force until someone switches it off.
// The watchdog runs in its own thread and calls only a stop function that may be called from any
// thread; it does not access the servo's data.
//
// The watchdog must be started from the servo's thread, and gets that thread's priority plus one.
// It sleeps from deadline to deadline, so it does not slow down the ticks.
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
    /// If no tick has ended this long after the stop, the loop is considered stuck.
    static constexpr Time kStuck = std::chrono::seconds(2);

    /// Calls `stop` once when no tick has ended for `limit`, and then `stuck` once when no tick has
    /// ended for another kStuck; both are called from the watchdog's thread. The time allowed for
    /// the first tick counts from construction.
    Watchdog(Time limit, std::function<void()> stop, std::function<void()> stuck);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// Called from the servo's thread at the end of each tick. Neither waits nor allocates memory.
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
