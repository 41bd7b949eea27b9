// The method of constant stimuli: each level is shown equally often, whatever is answered. A round
// has each level once, in an order by chance.
#pragma once

#include <algorithm>
#include <vector>

#include "base/random.h"
#include "task/procedures/estimate.h"

namespace dihaptic::task {

class Constant {
  public:
    /// `trials`: number after which it is done; the last round may be cut short. Throws Error when
    /// there is no level, or one is no number or comes twice.
    Constant(const std::vector<double>& levels, int trials, Random& random);

    double level() const { return levels_[std::min(answered_, levels_.size() - 1)]; }
    void answer(double /*level*/, bool /*yes*/) { ++answered_; }
    bool done() const { return answered_ >= levels_.size(); }
    /// None: it takes a fit of the answers.
    Estimate estimate() const { return {}; }

  private:
    std::vector<double> levels_;  // of all trials
    size_t answered_ = 0;
};

}  // namespace dihaptic::task
