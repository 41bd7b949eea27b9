// Suspension measures the duration of a suspension of the machine. The monotonic clock stands still
// meanwhile; by this clock, a tick after hours of sleep would be in time, although the hands have
// long let go.
#pragma once

#include "base/clock.h"

namespace dihaptic::servo {

class Suspension {
  public:
    /// A reading of the clock that runs during a suspension (boot), between two readings of the
    /// clock that does not.
    struct Clocks {
        Time before{0};
        Time boot{0};
        Time after{0};
    };
    static Clocks read() noexcept;

    explicit Suspension(const Clocks& clocks) : offset_(clocks.boot - clocks.before) {}

    /// Time suspended since the last call, or since construction; 0 if none. A thread
    /// that has to wait between two readings does not mistake the wait for a suspension.
    Time since(const Clocks& clocks) noexcept {
        const Time least = clocks.boot - clocks.after - offset_;
        if (least < kLeast) return Time(0);
        offset_ += least;
        return least;
    }

  private:
    static constexpr Time kLeast = std::chrono::milliseconds(1);
    Time offset_;  // lower bound of the boot clock's lead
};

}  // namespace dihaptic::servo
