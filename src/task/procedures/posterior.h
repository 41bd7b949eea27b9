// Functions on probabilities over a grid of values.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

namespace dihaptic::task {

/// Divides all values by their sum, which must be above 0.
void normalise(std::vector<double>& probabilities);

/// Lower limit of likelihoods, so that an answer that is impossible on a grid without lapses does
/// not make the posterior 0 everywhere.
inline constexpr double kLeastLikely = 1e-12;

/// Likelihood of an answer if "yes" has this probability.
inline double likelihood(double probability_of_yes, bool yes) {
    return std::max(yes ? probability_of_yes : 1 - probability_of_yes, kLeastLikely);
}

/// Mean of the values with these probabilities.
double mean(std::span<const double> values, std::span<const double> probabilities);

/// Value at which the cumulative probability, interpolated linearly between the ascending values,
/// reaches `share`; the first value if it reaches `share` there.
double quantile(std::span<const double> values, std::span<const double> probabilities,
                double share);

}  // namespace dihaptic::task
