// Probabilities on a grid.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

namespace dihaptic::experiment {

/// Divides by the sum, which is above 0.
void normalise(std::vector<double>& probabilities);

/// No answer is taken as less likely than this: one that a grid without lapses holds impossible
/// must not leave a posterior of nothing.
inline constexpr double kLeastLikely = 1e-12;

/// Of an answer, when "yes" has this probability.
inline double likelihood(double probability_of_yes, bool yes) {
    return std::max(yes ? probability_of_yes : 1 - probability_of_yes, kLeastLikely);
}

/// Of the ascending values, with these probabilities.
double mean(std::span<const double> values, std::span<const double> probabilities);

/// Where the cumulative probability, joined linearly from value to value, reaches `share`; the
/// first value where it is already past it.
double quantile(std::span<const double> values, std::span<const double> probabilities,
                double share);

}  // namespace dihaptic::experiment
