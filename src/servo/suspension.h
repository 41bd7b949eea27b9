// Suspension measures for how long the machine was suspended. The monotonic clock stands still
// during a suspension, so that a tick after hours of sleep would seem to be on time, although the
// hands have long let go.
#pragma once

#include "base/clock.h"

namespace dihaptic::servo {

class Suspension {
  public:
    /// A reading of the boot clock, which keeps running during a suspension, taken between two
    /// readings of the monotonic clock, which does not.
    struct Clocks {
        Time before{0};
        Time boot{0};
        Time after{0};
    };
    static Clocks read() noexcept;

    explicit Suspension(const Clocks& clocks) : offset_(clocks.boot - clocks.before) {}

    /// Time for which the machine was suspended since the last call or, in the first call, since
    /// construction; 0 if it was not suspended. If the thread has to wait between two clock
    /// readings, the wait is not mistaken for a suspension.
    Time since(const Clocks& clocks) noexcept {
        const Time least = clocks.boot - clocks.after - offset_;
        if (least < kLeast) return Time(0);
        offset_ += least;
        return least;
    }

  private:
    static constexpr Time kLeast = std::chrono::milliseconds(1);
    Time offset_;  // lower bound on how far the boot clock is ahead
};

}  // namespace dihaptic::servo
