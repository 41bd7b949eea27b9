// The method of constant stimuli: each level is presented equally often, regardless of the answers.
// Each round contains every level once, in random order.
#pragma once

#include <algorithm>
#include <vector>

#include "base/random.h"
#include "task/procedures/estimate.h"

namespace dihaptic::task {

class Constant {
  public:
    /// `trials` is the number of trials after which the procedure ends; the last round may be
    /// incomplete. Throws Error if there are no levels, or if a level is not a number or is
    /// repeated.
    Constant(const std::vector<double>& levels, int trials, Random& random);

    double level() const { return levels_[std::min(answered_, levels_.size() - 1)]; }
    void answer(double /*level*/, bool /*yes*/) { ++answered_; }
    bool done() const { return answered_ >= levels_.size(); }
    /// Returns no estimate, since this would require a fit to the answers.
    Estimate estimate() const { return {}; }

  private:
    std::vector<double> levels_;  // level of each trial
    size_t answered_ = 0;
};

}  // namespace dihaptic::task
