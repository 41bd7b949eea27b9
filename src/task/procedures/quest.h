// QUEST (Watson and Pelli 1983) estimates a threshold by its posterior on a grid; all other
// parameters of the psychometric function are assumed to be known. For the logarithm x of the
// stimulus (base 10),
//
//     p(x) = delta gamma + (1 - delta) (1 - (1 - gamma) exp(-10^(beta (x - T + e))))
//
// with T the threshold, and e such that p(T) = `target`. Each trial is at the most informative
// quantile of the posterior (Pelli 1987); the estimate is the posterior's mean (King-Smith et al.
// 1994).
#pragma once

#include <vector>

#include "task/procedures/estimate.h"

namespace dihaptic::task {

struct QuestSettings {
    double prior_mean = 0;  ///< mean of the threshold's prior, log10
    double prior_sd = 1;    ///< standard deviation of the prior, log10; choose it generously
    double target = 0.82;   ///< probability of "yes" at threshold
    double slope = 3.5;     ///< beta
    double guess = 0.5;     ///< gamma
    double blind = 0.01;    ///< delta: share of trials answered blindly
    double grain = 0.01;    ///< step of the grid, log10
    int cells = 500;        ///< even; the grid extends cells / 2 grains to each side of prior_mean
    int trials = 40;        ///< number of trials after which the procedure ends
};

class Quest {
  public:
    /// Throws Error if a setting is out of range.
    explicit Quest(const QuestSettings& settings);

    double level() const;
    /// The level is rounded to the nearest point of the grid.
    void answer(double level, bool yes);
    bool done() const { return trials_ >= settings_.trials; }
    /// Mean of the posterior, and its quantiles.
    Estimate estimate() const;

    double sd() const;
    /// Quantile of the posterior, interpolated between points of the grid.
    double quantile(double share) const;
    /// The grid, and the probability of each of its thresholds.
    const std::vector<double>& thresholds() const { return thresholds_; }
    const std::vector<double>& posterior() const { return posterior_; }

  private:
    QuestSettings settings_;
    double best_quantile_ = 0.5;  // quantile at which a trial is most informative
    int trials_ = 0;
    std::vector<double> thresholds_;
    std::vector<double> posterior_;
    std::vector<double> yes_;  // by level minus threshold, from -cells to cells grains
};

}  // namespace dihaptic::task
