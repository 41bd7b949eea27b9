// How late the ticks come that the loop really does, from their times alone, which are recorded: a
// replay finds the same.
//
//     L = sum T_i (T_i - h) / sum T_i
//
// over the last second, h being the period and T_i the time from each tick to the next; those of up
// to 3 h / 2 count as in time. It says what stiffness is held (haptics/late_loop.h). The longest
// one is left out: a single pause is a fault when it is too long, and otherwise forgiven. L reaches
// the coupling through a low-pass, so that nothing that is felt changes at once.
#pragma once

#include <vector>

#include "base/clock.h"

namespace dihaptic::servo {

class Lateness {
  public:
    explicit Lateness(Time period);

    /// A tick at `now`, so long after the one before. Allocates nothing.
    void tick(Time now, Time elapsed) noexcept;
    /// As if all had been in time.
    void restart() noexcept;

    /// L, eased; exactly 0 when the loop is well [s].
    double sustained() const noexcept { return sustained_; }
    /// By how much the next tick must be expected to be late: as much as this one or one shortly
    /// before. Exactly 0 when the loop is well [s].
    double expected() const noexcept { return expected_; }

  private:
    double mean() const noexcept;

    struct Late {
        Time at{0};
        double elapsed = 0;  // [s]
    };
    Time period_;
    std::vector<Late> late_;  // of the last second, a ring
    size_t first_ = 0;
    size_t count_ = 0;
    double sustained_ = 0;
    double expected_ = 0;
};

}  // namespace dihaptic::servo
