// These functions run the ticks of a servo: either on the virtual clock, as fast as the machine
// allows, or in real time, in a separate thread.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "servo/real_time.h"
#include "servo/servo.h"

namespace dihaptic::servo {

/// Durations, one per tick. Memory must be reserved before a real-time run; once it is full,
/// further durations are dropped.
class TickTimes {
  public:
    void reserve(size_t ticks) { us_.reserve(ticks); }
    void add(double seconds) noexcept {
        if (us_.size() < us_.capacity()) us_.push_back(static_cast<float>(seconds * 1e6));
    }
    size_t count() const { return us_.size(); }
    std::span<const float> us() const { return us_; }
    /// The quantile at `share` [us], e.g. 0.5 for the median; NaN if there are no ticks.
    double quantile(double share) const;

  private:
    std::vector<float> us_;
};

/// Describes how punctual a run was. On the virtual clock, on which ticks are never late, only
/// `ticks` is filled in.
struct Timing {
    TickTimes ticks;
    TickTimes lateness;  ///< lateness of each tick's wake-up
    Time reached{0};     ///< time of the last tick
    int64_t overruns = 0;
    /// What the watchdog found and did when no tick ended any more.
    struct Stall {
        Time at{0};            ///< since activation
        Time pause{0};         ///< time since the end of the last tick
        bool stopped = false;  ///< whether the devices could be stopped; some devices cannot
    };
    std::optional<Stall> stall;
    /// Number of ticks that were later than allowed while all devices were simulated. Such ticks
    /// are only reported.
    int64_t pauses = 0;
    double longest_pause = 0;  ///< [s]
    RealTime::Refusals refusals;

    void reserve(size_t count) {
        ticks.reserve(count);
        lateness.reserve(count);
    }
};

/// Describes how late the ticks of a real-time run woke up; "" if there are none.
std::string describe(const Timing& timing);

/// Describes the pauses in a sentence; "" if there were none.
std::string describe_pauses(const Timing& timing);

/// Describes in a sentence what the watchdog did.
std::string describe(const Timing::Stall& stall);

/// Runs ticks on the virtual clock until the director stops, `stop` becomes true, or session time
/// `most` is reached. Devices that pace the run call the ticks themselves, one per period of
/// virtual time. Returns the time reached.
Time run_virtual(Servo& servo, const frame::Director& director, const frame::FrameSink& sink,
                 Time most, const std::atomic<bool>& stop, TickTimes* times = nullptr);

/// Runs the ticks from time `first` to time `last` in real time, in a separate thread with the
/// permissions that RealTime obtained. A tick runs at each deadline of Pace, which uses the
/// monotonic clock plus any time for which the machine was suspended. Devices that pace the run
/// call the ticks themselves instead. If no tick has ended for longer than `max_pause`, a Watchdog
/// stops real devices. If the loop then continues, the next tick finds that it is late. If the loop
/// never continues, `stuck` is called from the watchdog's thread: this function can no longer
/// return, and the program should end.
void run_real(Servo& servo, const frame::Director& director, const frame::FrameSink& sink,
              Time first, Time last, const std::atomic<bool>& stop, Timing& timing,
              const std::function<void(const Timing::Stall&)>& stuck = {});

}  // namespace dihaptic::servo
