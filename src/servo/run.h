// Who calls the tick: the virtual clock, as fast as the machine goes, or a thread that keeps real
// time.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "servo/real_time.h"
#include "servo/servo.h"

namespace dihaptic::servo {

/// What becomes of each Frame. On the real clock it runs in the servo thread: no waiting, no
/// memory.
using FrameSink = std::function<void(const Frame&)>;

/// Times, one a tick. Reserve before a real-time run: those beyond are left out.
class TickTimes {
  public:
    void reserve(size_t ticks) { us_.reserve(ticks); }
    void add(double seconds) noexcept {
        if (us_.size() < us_.capacity()) us_.push_back(static_cast<float>(seconds * 1e6));
    }
    size_t count() const { return us_.size(); }
    std::span<const float> us() const { return us_; }
    /// The share-quantile, e.g. 0.5 for the median [us]; NaN without ticks.
    double quantile(double share) const;

  private:
    std::vector<float> us_;
};

/// How runs kept time; on the virtual clock, which is never late, only `ticks`.
struct Timing {
    TickTimes ticks;
    TickTimes lateness;  ///< of each tick's wake-up
    Time reached{0};     ///< the last tick's
    int64_t overruns = 0;
    /// When the watchdog found that ticks did not end any more.
    struct Stall {
        Time at{0};            ///< from activation
        Time pause{0};         ///< since the last tick had ended
        bool stopped = false;  ///< the devices, which not all can be
    };
    std::optional<Stall> stall;
    /// Ticks that came later than allowed where devices are simulated, which is told alone.
    int64_t pauses = 0;
    double longest_pause = 0;  ///< [s]
    RealTime::Refusals refusals;

    void reserve(size_t count) {
        ticks.reserve(count);
        lateness.reserve(count);
    }
};

/// The wake-ups of a run in real time, in words; "" without any.
std::string describe(const Timing& timing);

/// The pauses, in a sentence; "" without any.
std::string describe_pauses(const Timing& timing);

/// What the watchdog did, in a sentence.
std::string describe(const Timing::Stall& stall);

/// Ticks until the director stops, `stop` becomes true, or `most` time has passed; called by
/// devices that pace, a period of virtual time each. Returns the time reached.
Time run_virtual(Servo& servo, const Director& director, const FrameSink& sink, Time most,
                 const std::atomic<bool>& stop, TickTimes* times = nullptr);

/// The same in real time, from `first` to `last`, in a thread of its own with what RealTime gets
/// it: a tick at each deadline of Pace, on the monotonic clock, to which the time is added that the
/// machine was suspended for. A Watchdog stops real devices when no tick has ended for longer than
/// `max_pause`; when the loop goes on, the next tick finds that it is late. When it never does,
/// `stuck` is called from the watchdog's thread: this function cannot return any more, and the
/// program had better end.
void run_real(Servo& servo, const Director& director, const FrameSink& sink, Time first, Time last,
              const std::atomic<bool>& stop, Timing& timing,
              const std::function<void(const Timing::Stall&)>& stuck = {});

}  // namespace dihaptic::servo
