// Measures the lateness of the loop's ticks from nothing but the ticks' times. Since these times
// are recorded, a replay gives the same lateness.
//
//     L = sum T_i (T_i - h) / sum T_i
//
// where the sums are over the last second, h is the period and T_i are the times between
// consecutive ticks; intervals of up to 3 h / 2 count as on time. L determines the coupling
// stiffness allowed for the loop (haptics/late_loop.h). The longest interval is left out, because a
// single pause is either a fault (if it is too long) or forgiven. L is low-pass filtered before it
// changes the coupling, so that the hand feels no abrupt change.
#pragma once

#include <vector>

#include "base/clock.h"

namespace dihaptic::servo {

class Lateness {
  public:
    explicit Lateness(Time period);

    /// Notes a tick at time `now`, which came `elapsed` after the previous tick. Does not allocate
    /// memory.
    void tick(Time now, Time elapsed) noexcept;
    /// Forgets the lateness of all earlier ticks.
    void restart() noexcept;

    /// L after the low-pass filter [s]; exactly 0 if the ticks are on time.
    double sustained() const noexcept { return sustained_; }
    /// Expected lateness of the next tick: the lateness of this tick or of a tick shortly before it
    /// [s]. Exactly 0 if the ticks are on time.
    double expected() const noexcept { return expected_; }

  private:
    double mean() const noexcept;

    struct Late {
        Time at{0};
        double elapsed = 0;  // [s]
    };
    Time period_;
    std::vector<Late> late_;  // ring of the late intervals in the last second
    size_t first_ = 0;
    size_t count_ = 0;
    double sustained_ = 0;
    double expected_ = 0;
};

}  // namespace dihaptic::servo
