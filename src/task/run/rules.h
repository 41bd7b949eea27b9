// Follows a task's rules, which change its variables at the end of each attempt. They use measures
// of the attempt, and statistics over earlier trials.
#pragma once

#include <vector>

#include "base/unmeasured.h"
#include "frame/orders.h"
#include "task/plan/taken.h"
#include "task/run/trial_numbers.h"

namespace dihaptic::task {

class Rules {
  public:
    /// `plan` must outlive this object. `quantities`: number of the quantities' values.
    Rules(const TaskPlan& plan, size_t quantities);

    /// Must be called in each tick, before the quantities are updated.
    void keep(std::span<const double> values) noexcept {
        if (!taken_.empty()) std::ranges::copy(values, in_frame_.begin());
    }
    /// Adds the last Frame's values to the measures that rules use. Exits use the handles of the
    /// current tick, but measures use only the last Frame, as do the columns with the same names.
    void take_measures(const frame::Frame& last, int state, Quantities& quantities) noexcept;
    /// Forgets the measures of an attempt that is interrupted.
    void clear() noexcept {
        for (Taken& taken : taken_) taken.clear();
    }
    /// Changes the variables at the end of an attempt. `counts` tells whether the attempt counts
    /// in the statistics over earlier trials.
    void follow(int outcome, bool counts, TrialNumbers& numbers,
                std::vector<frame::VariableFrame>& variables) noexcept;

  private:
    void look_back(size_t from, size_t to, bool counts, Quantities& quantities) noexcept;

    /// The values of a look-back's expression at the ends of the last trials.
    struct Past {
        std::vector<double> values;  // ring buffer, filled from the beginning
        std::vector<double> sorted;
        size_t next = 0;
        double best = kUnmeasured;
    };

    const TaskPlan& plan_;
    std::vector<Taken> taken_;                  // one for each measure used in rules
    std::vector<double> in_frame_;              // quantities in the last Frame
    std::vector<frame::Handle> frame_handles_;  // handles in the last Frame
    std::vector<Past> past_;
};

}  // namespace dihaptic::task
