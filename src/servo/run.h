// Who calls the tick: the virtual clock, as fast as the machine goes, or a thread that keeps real
// time.
#pragma once

#include <atomic>
#include <vector>

#include "servo/servo.h"

namespace dihaptic::servo {

/// What becomes of each Frame. On the real clock it runs in the servo thread: no waiting, no
/// memory.
using FrameSink = std::function<void(const Frame&)>;

/// How long ticks took. Reserve before a real-time run.
class TickTimes {
  public:
    void reserve(size_t ticks) { us_.reserve(ticks); }
    void add(double seconds) noexcept {
        if (us_.size() < us_.capacity()) us_.push_back(static_cast<float>(seconds * 1e6));
    }
    size_t count() const { return us_.size(); }
    /// The share-quantile, e.g. 0.5 for the median [us]; NaN without ticks.
    double quantile(double share) const;

  private:
    std::vector<float> us_;
};

/// Ticks until the director stops, `stop` becomes true, or `most` time has passed. Returns the time
/// reached.
Time run_virtual(Servo& servo, const Director& director, const FrameSink& sink, Time most,
                 const std::atomic<bool>& stop, TickTimes* times = nullptr);

/// The same in real time, in a thread of its own, one tick each period of the monotonic clock. A
/// tick that ends after the next should have begun is an overrun: the ticks that it missed are left
/// out. `reached` follows the session's time for whoever watches. Returns the number of overruns.
struct RealTimeResult {
    Time reached{0};
    int64_t overruns = 0;
};
RealTimeResult run_real(Servo& servo, const Director& director, const FrameSink& sink, Time most,
                        const std::atomic<bool>& stop, TickTimes& times,
                        std::atomic<int64_t>& reached);

}  // namespace dihaptic::servo
