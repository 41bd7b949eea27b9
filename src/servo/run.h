// Runs call the tick: on the virtual clock, as fast as the machine allows, or in a thread that
// keeps real time.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "servo/real_time.h"
#include "servo/servo.h"

namespace dihaptic::servo {

/// Durations, one for each tick. To be reserved before a real-time run; once full, it drops further
/// values.
class TickTimes {
  public:
    void reserve(size_t ticks) { us_.reserve(ticks); }
    void add(double seconds) noexcept {
        if (us_.size() < us_.capacity()) us_.push_back(static_cast<float>(seconds * 1e6));
    }
    size_t count() const { return us_.size(); }
    std::span<const float> us() const { return us_; }
    /// The quantile at `share`, e.g. 0.5 for the median [us]; NaN without ticks.
    double quantile(double share) const;

  private:
    std::vector<float> us_;
};

/// The punctuality of a run. On the virtual clock, which is never late, only `ticks` is filled in.
struct Timing {
    TickTimes ticks;
    TickTimes lateness;  ///< lateness of each tick's wake-up
    Time reached{0};     ///< time of the last tick
    int64_t overruns = 0;
    /// The watchdog's finding when ticks no longer ended.
    struct Stall {
        Time at{0};            ///< since activation
        Time pause{0};         ///< since the end of the last tick
        bool stopped = false;  ///< whether the devices could be stopped; not all devices can
    };
    std::optional<Stall> stall;
    /// Number of ticks later than allowed while all devices are simulated; only reported.
    int64_t pauses = 0;
    double longest_pause = 0;  ///< [s]
    RealTime::Refusals refusals;

    void reserve(size_t count) {
        ticks.reserve(count);
        lateness.reserve(count);
    }
};

/// Describes the lateness of the wake-ups of a real-time run; "" without wake-ups.
std::string describe(const Timing& timing);

/// Describes the pauses in a sentence; "" without pauses.
std::string describe_pauses(const Timing& timing);

/// Describes the watchdog's action in a sentence.
std::string describe(const Timing::Stall& stall);

/// Runs ticks on the virtual clock until the director stops, `stop` becomes true, or time `most`
/// has passed. Devices that pace call the ticks, one per period of virtual time. Returns the time
/// reached.
Time run_virtual(Servo& servo, const frame::Director& director, const frame::FrameSink& sink,
                 Time most, const std::atomic<bool>& stop, TickTimes* times = nullptr);

/// Runs the ticks from `first` to `last` in real time, in a thread of its own with the permissions
/// that RealTime obtained. A tick runs at each deadline of Pace, on the monotonic clock plus any
/// time for which the machine was suspended; devices that pace call the ticks instead. A Watchdog
/// stops real devices when no tick has ended for longer than `max_pause`; if the loop then
/// continues, the next tick detects that it is late. If it never does, `stuck` is called from the
/// watchdog's thread: this function can no longer return, and the program should end.
void run_real(Servo& servo, const frame::Director& director, const frame::FrameSink& sink,
              Time first, Time last, const std::atomic<bool>& stop, Timing& timing,
              const std::function<void(const Timing::Stall&)>& stuck = {});

}  // namespace dihaptic::servo
