// Psychometric functions: the probability of "yes" (or "correct") at a stimulus level x,
//
//     p(x) = gamma + (1 - gamma - lambda) F(x; t, s)
//
// where gamma is the guess rate and lambda is the lapse rate. The sigmoid F has a threshold t and a
// shape s:
//
//     normal         Phi((x - t) / s)                 F(t) = 0.5       s: standard deviation
//     logistic       1 / (1 + exp(-(x - t) / s))      F(t) = 0.5       s: scale
//     weibull        1 - exp(-(x / t)^s),  x > 0      F(t) = 1 - 1/e   s: slope, beta
//     weibull_log10  1 - exp(-10^(s (x - t)))      F(t) = 1 - 1/e   s: slope, beta
//
// x and t have the unit of the level, except that for weibull_log10, the Weibull function of the
// logarithm, they are log10 of the level. In the first two sigmoids, s has the unit of the level;
// in the last two, s is a dimensionless slope. Sources: Wichmann and Hill 2001; Watson and Pelli
// 1983 for weibull_log10.
#pragma once

#include <array>

namespace dihaptic::model {

enum class Sigmoid { normal, logistic, weibull, weibull_log10 };
constexpr auto enum_names(Sigmoid) {
    return std::array{"normal", "logistic", "weibull", "weibull_log10"};
}

/// Whether a sigmoid is defined at a level: `weibull` is undefined at 0 or below.
constexpr bool takes(Sigmoid sigmoid, double level) {
    return sigmoid != Sigmoid::weibull || level > 0;
}

struct Psychometric {
    Sigmoid sigmoid = Sigmoid::normal;
    double threshold = 0;
    double shape = 1;  ///< > 0
    double guess = 0;  ///< probability of "yes" far below the threshold
    double lapse = 0;  ///< probability of "no" far above the threshold

    /// Returns the probability of "yes" at a level, which is in [guess, 1 - lapse].
    double probability(double level) const;
    /// Inverse of probability(): returns the level at which "yes" has this probability. NaN unless
    /// the probability lies between guess and 1 - lapse.
    double level(double probability) const;
    /// Standard deviation of the distribution whose cumulative distribution function is the
    /// sigmoid, in the unit of the level.
    double sd() const;
};

}  // namespace dihaptic::model
