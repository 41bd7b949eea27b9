// QUEST (Watson and Pelli 1983) estimates a threshold from its posterior on a grid; all other
// parameters of the psychometric function are assumed to be known. For the logarithm x of the
// stimulus (base 10),
//
//     p(x) = delta gamma + (1 - delta) (1 - (1 - gamma) exp(-10^(beta (x - T + e))))
//
// where T is the threshold and e is such that p(T) = `target`. Each trial is at the most
// informative quantile of the posterior (Pelli 1987); the estimate is the mean of the posterior
// (King-Smith et al. 1994).
#pragma once

#include <vector>

#include "task/procedures/estimate.h"

namespace dihaptic::task {

struct QuestSettings {
    double prior_mean = 0;  ///< mean of the prior of the threshold, log10
    double prior_sd = 1;    ///< standard deviation of the prior, log10; should be generous
    double target = 0.82;   ///< probability of "yes" at the threshold
    double slope = 3.5;     ///< beta
    double guess = 0.5;     ///< gamma
    double blind = 0.01;    ///< delta: fraction of trials answered blindly
    double grain = 0.01;    ///< spacing of the grid, log10
    /// Must be even; the grid extends cells / 2 grains to each side of prior_mean.
    int cells = 500;
    int trials = 40;  ///< number of trials after which the procedure ends
};

class Quest {
  public:
    /// Throws Error if a setting is out of range.
    explicit Quest(const QuestSettings& settings);

    double level() const;
    /// Processes an answer. The level is rounded to the nearest point of the grid.
    void answer(double level, bool yes);
    bool done() const { return trials_ >= settings_.trials; }
    /// Returns the mean of the posterior and the quantiles that bound the interval.
    Estimate estimate() const;

    double sd() const;
    /// Returns a quantile of the posterior, interpolated between points of the grid.
    double quantile(double share) const;
    /// Points of the grid of thresholds, and the probability of each threshold.
    const std::vector<double>& thresholds() const { return thresholds_; }
    const std::vector<double>& posterior() const { return posterior_; }

  private:
    QuestSettings settings_;
    double best_quantile_ = 0.5;  // quantile of the posterior at which a trial is most informative
    int trials_ = 0;
    std::vector<double> thresholds_;
    std::vector<double> posterior_;
    // probability of "yes" for a level minus threshold of -cells to cells grains
    std::vector<double> yes_;
};

}  // namespace dihaptic::task
