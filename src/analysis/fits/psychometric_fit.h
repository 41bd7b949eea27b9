// Fits the psychometric function that makes the answers of an experiment most likely, and estimates
// its reliability (Wichmann and Hill 2001, I and II).
#pragma once

#include <cstdint>
#include <optional>
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

/// Counts answers by level, ascending; levels that differ only by rounding are one level.
std::vector<LevelCount> count(std::span<const Answer> answers);

struct PsychometricFitSettings {
    model::Sigmoid sigmoid = model::Sigmoid::normal;
    double guess = 0.5;
    /// Uses the lapse rate as the guess rate instead: for "more or less?" questions.
    bool guess_is_lapse = false;
    double max_lapse = 0.05;  ///< the lapse rate is fitted within [0, max_lapse]
    /// The known shape; unset: fitted. It must be known after a procedure that asks only near the
    /// threshold: such answers make the function look steeper than it is (Kaernbach 2001), and the
    /// threshold more certain.
    std::optional<double> shape = std::nullopt;
};

struct PsychometricFit {
    model::Psychometric function;
    /// Sum over trials of -ln p(answer), without the binomial coefficients.
    double negative_log_likelihood = 0;
    /// Twice the log likelihood that is lost relative to the model with each level's own share of
    /// "yes" [1]. If each level has many trials, the deviance is approximately chi-squared
    /// distributed, and its degrees of freedom are the number of levels minus the number of
    /// parameters; if not, see `deviance_share()` below.
    double deviance = 0;
    /// Functions far steeper, or far flatter, than any that the levels could tell apart fit as
    /// well: the answers turn from all "no" to all "yes" between two levels, or have no trend. The
    /// shape is then meaningless.
    bool shape_unknown = false;
};

/// Throws Error for fewer than two levels, for impossible counts, and for levels that are not
/// positive with Sigmoid::weibull.
PsychometricFit fit_psychometric(std::span<const LevelCount> counts,
                                 const PsychometricFitSettings& settings);

struct PsychometricIntervals {
    Interval threshold, shape, lapse;  ///< 95 %
};

/// Intervals of the profile likelihood: the values with which, after refitting the other
/// parameters, twice the log likelihood falls by no more than 3.84. The likelihood does not depend
/// on how the levels were chosen, so these intervals also hold after adaptive procedures; intervals
/// from a bootstrap at the same levels do not.
PsychometricIntervals profile_intervals(std::span<const LevelCount> counts,
                                        const PsychometricFit& fit,
                                        const PsychometricFitSettings& settings);

/// Share of the resamples of a parametric bootstrap that fit no better than the data: below 0.05
/// the model does not describe the data. In each resample, the fitted function answers the same
/// number of trials at each level, and these answers are fitted.
double deviance_share(std::span<const LevelCount> counts, const PsychometricFit& fit,
                      const PsychometricFitSettings& settings, int resamples, uint64_t seed);

}  // namespace dihaptic::analysis
