// Measures the lateness of the loop's ticks from the ticks' times alone. These are recorded, so a
// replay gives the same value.
//
//     L = sum T_i (T_i - h) / sum T_i
//
// over the last second, where h is the period and T_i the time from each tick to the next; an
// interval of up to 3 h / 2 counts as in time. L determines the stiffness allowed for the loop
// (haptics/late_loop.h). The longest interval is left out, because a single pause is either a fault
// (if too long) or forgiven. L reaches the coupling through a low-pass filter, so that there is no
// abrupt change under the hand.
#pragma once

#include <vector>

#include "base/clock.h"

namespace dihaptic::servo {

class Lateness {
  public:
    explicit Lateness(Time period);

    /// Notes a tick at `now`, `elapsed` after the one before. Allocates nothing.
    void tick(Time now, Time elapsed) noexcept;
    /// Forgets all lateness.
    void restart() noexcept;

    /// L after the low-pass filter; exactly 0 when the loop keeps time [s].
    double sustained() const noexcept { return sustained_; }
    /// Expected lateness of the next tick: that of this tick, or of one shortly before
    /// it. Exactly 0 when the loop keeps time [s].
    double expected() const noexcept { return expected_; }

  private:
    double mean() const noexcept;

    struct Late {
        Time at{0};
        double elapsed = 0;  // [s]
    };
    Time period_;
    std::vector<Late> late_;  // late intervals of the last second, a ring
    size_t first_ = 0;
    size_t count_ = 0;
    double sustained_ = 0;
    double expected_ = 0;
};

}  // namespace dihaptic::servo
