// The k-down 1-up staircase: k "yes" answers in a row lower the level, and one "no" raises it. With
// steps up U and down D, it converges to the level at which up and down steps balance,
// p^k D = (1 - p^k) U:
//
//     p = (1 + D/U)^(-1/k)
//
// For k = 1, this is the weighted method of Kaernbach (1991) and holds for all step sizes. If k is
// larger, the equation holds well only for the ratios of Garcia-Perez (1998), kGarciaPerez. Steps
// are additive; for multiplicative steps, use the logarithms of the levels.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "task/procedures/estimate.h"

namespace dihaptic::task {

struct StaircaseSettings {
    int down_after = 2;  ///< k: number of consecutive "yes" answers that lower the level
    double start = 0;    ///< level of the first trial
    /// Steps up after 0, 1, 2, ... reversals; the last value also applies after any further
    /// reversals.
    std::vector<double> steps_up = {1};
    double down_over_up = 1;  ///< D/U
    /// Limits on the levels.
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    /// Number of reversals, and number of trials, after which the staircase ends; 0 for no such
    /// limit. At least one limit is required.
    int reversals = 0;
    int trials = 0;
    /// Number of initial reversals that the estimate ignores.
    int skipped_reversals = 0;
};

/// Ratios D/U at which the closed form above holds best, for 1-, 2-, 3- and 4-down staircases
/// (Garcia-Perez 1998).
inline constexpr std::array<double, 4> kGarciaPerez = {0.2845, 0.5488, 0.7393, 0.8415};

/// Returns the probability of "yes" to which a staircase converges: (1 + D/U)^(-1/k).
double settling_probability(int down_after, double down_over_up);
/// Returns the D/U for which a staircase converges to p: p^-k - 1. For k = 1, this is Kaernbach's
/// ratio.
double down_over_up_for(int down_after, double probability);

class Staircase {
  public:
    /// Throws Error if a setting is out of range.
    explicit Staircase(StaircaseSettings settings);

    double level() const { return level_; }
    void answer(double level, bool yes);
    bool done() const;
    /// Returns the mean of an even number of reversals, so that peaks and valleys have equal
    /// weight, or NaN if there are none. The estimate has no interval, because reversals are few
    /// and not independent; to get an interval, fit the trials instead (analysis/fits).
    Estimate estimate() const;

    const StaircaseSettings& settings() const { return settings_; }
    /// Levels of the trials after which the direction of the staircase changed.
    const std::vector<double>& reversals() const { return reversals_; }

  private:
    void move(double level, int direction);

    StaircaseSettings settings_;
    double level_;
    int trials_ = 0;
    int in_a_row_ = 0;  // number of "yes" answers since the last change of level
    // direction of the last change of level: -1 or 1; 0 before the first change
    int direction_ = 0;
    std::vector<double> reversals_;
};

}  // namespace dihaptic::task
