// The psychometric function that makes the answers of an experiment most likely, and how far it is
// to be trusted (Wichmann and Hill 2001, I and II).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/fits/minimise.h"
#include "model/psychometric.h"

namespace dihaptic::analysis {

/// All trials at one level.
struct LevelCount {
    double level = 0;
    int yes = 0;
    int trials = 0;
};

struct Answer {
    double level = 0;
    bool yes = false;
};

/// By level, ascending; levels that differ by rounding only are one.
std::vector<LevelCount> count(std::span<const Answer> answers);

struct PsychometricFitSettings {
    model::Sigmoid sigmoid = model::Sigmoid::normal;
    double guess = 0.5;
    /// The guess rate is the lapse rate, instead: for "more or less?" questions.
    bool guess_is_lapse = false;
    double max_lapse = 0.05;  ///< the lapse rate is fitted within [0, max_lapse]
};

struct PsychometricFit {
    model::Psychometric function;
    /// Sum over trials of -ln p(answer), without the binomial coefficients.
    double negative_log_likelihood = 0;
    /// Twice the log likelihood lost to the model that has each level's share of "yes" [1]. About
    /// chi-squared distributed, with levels less parameters degrees of freedom, where each level
    /// has many trials; see `deviance_share` below for where not.
    double deviance = 0;
    /// Functions far steeper, or far flatter, than any that the levels could tell apart fit as
    /// well: the answers turn from all "no" to all "yes" between two levels, or have no trend. The
    /// shape means nothing.
    bool shape_unknown = false;
};

/// Throws Error for less than two levels, counts that are impossible, or levels that are not
/// positive for Sigmoid::weibull.
PsychometricFit fit_psychometric(std::span<const LevelCount> counts,
                                 const PsychometricFitSettings& settings);

struct PsychometricIntervals {
    Interval threshold, shape, lapse;  ///< 95 %
    /// Share of the resamples that fit no better than the data did: below 0.05 the model does not
    /// describe them.
    double deviance_share = 0;
};

/// Parametric bootstrap: `resamples` times, as many trials at the same levels are answered by the
/// fitted function, and fitted. Intervals hold the middle 95 % of them.
PsychometricIntervals bootstrap(std::span<const LevelCount> counts, const PsychometricFit& fit,
                                const PsychometricFitSettings& settings, int resamples,
                                uint64_t seed);

}  // namespace dihaptic::analysis
