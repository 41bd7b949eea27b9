// The k-down 1-up staircase: k "yes" answers in a row lower the level, and one "no" raises it. With
// steps up U and down D, it converges to the level at which they balance, p^k D = (1 - p^k) U:
//
//     p = (1 + D/U)^(-1/k)
//
// For k = 1 this is the weighted method of Kaernbach (1991), for all step sizes. For k
// > 1 it holds well only at the ratios of Garcia-Perez (1998), kGarciaPerez. Steps are additive:
// for multiplicative steps, use logarithms of the levels.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "task/procedures/estimate.h"

namespace dihaptic::task {

struct StaircaseSettings {
    int down_after = 2;  ///< k: number of consecutive "yes" answers that lower the level
    double start = 0;    ///< level of the first trial
    /// Step up after 0, 1, 2, ... reversals; the last value applies from then on.
    std::vector<double> steps_up = {1};
    double down_over_up = 1;  ///< D/U
    /// Limits of the levels.
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    /// Numbers of reversals or trials after which the staircase ends; 0: no such limit. At least
    /// one is required.
    int reversals = 0;
    int trials = 0;
    /// Number of initial reversals that are ignored in the estimate.
    int skipped_reversals = 0;
};

/// D/U for 1, 2, 3 and 4-down at which the closed form above holds best (Garcia-Perez 1998).
inline constexpr std::array<double, 4> kGarciaPerez = {0.2845, 0.5488, 0.7393, 0.8415};

/// Probability of "yes" to which a staircase converges: (1 + D/U)^(-1/k).
double settling_probability(int down_after, double down_over_up);
/// The D/U with which a staircase converges to p: p^-k - 1. For k = 1 this is Kaernbach's ratio.
double down_over_up_for(int down_after, double probability);

class Staircase {
  public:
    /// Throws Error if a setting is out of range.
    explicit Staircase(StaircaseSettings settings);

    double level() const { return level_; }
    void answer(double level, bool yes);
    bool done() const;
    /// Mean of an even number of reversals, so that peaks and valleys have equal weight; NaN if
    /// there are none. The estimate has no interval, because reversals are few and not independent:
    /// fit the trials instead (analysis/fits).
    Estimate estimate() const;

    const StaircaseSettings& settings() const { return settings_; }
    /// Levels of trials after which the direction changed.
    const std::vector<double>& reversals() const { return reversals_; }

  private:
    void move(double level, int direction);

    StaircaseSettings settings_;
    double level_;
    int trials_ = 0;
    int in_a_row_ = 0;   // number of "yes" answers since the last change of level
    int direction_ = 0;  // direction of the last change: -1 or 1; 0 before the first
    std::vector<double> reversals_;
};

}  // namespace dihaptic::task
