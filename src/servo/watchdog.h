// A thread of its own that switches force off when the loop stalls: when a call to a device blocks,
// or the system keeps the servo's thread waiting, devices hold the last force until somebody else
// takes it away. It calls nothing but a stop that may be called from any thread; what the servo
// computes is none of its business.
//
// Started from the servo's thread it has that one's priority and one more. It sleeps from deadline
// to deadline, so ticks cost it nothing.
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
    /// After the stop, a tick that has not ended for so long more never will.
    static constexpr Time kStuck = std::chrono::seconds(2);

    /// `stop` is called once when no tick has ended for `limit`, `stuck` once when none has for
    /// kStuck after it; both from the watchdog's thread. The first tick counts from here.
    Watchdog(Time limit, std::function<void()> stop, std::function<void()> stuck);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// From the servo's thread, at the end of each tick. Neither waits nor allocates.
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
