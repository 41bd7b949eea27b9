// Functions of probabilities on a grid of values.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

namespace dihaptic::task {

/// Divides all values by their sum, which must be positive.
void normalise(std::vector<double>& probabilities);

/// Lower limit on likelihoods. It prevents an answer that is impossible on a grid without lapses
/// from making the posterior 0 everywhere.
inline constexpr double kLeastLikely = 1e-12;

/// Returns the likelihood of an answer, given the probability of "yes".
inline double likelihood(double probability_of_yes, bool yes) {
    return std::max(yes ? probability_of_yes : 1 - probability_of_yes, kLeastLikely);
}

/// Returns the mean of values that have these probabilities.
double mean(std::span<const double> values, std::span<const double> probabilities);

/// Returns the value at which the cumulative probability, interpolated linearly between the
/// ascending values, reaches `share`. If it already reaches `share` at the first value, returns
/// that value.
double quantile(std::span<const double> values, std::span<const double> probabilities,
                double share);

}  // namespace dihaptic::task
