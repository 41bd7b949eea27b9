// Fits the psychometric function that makes the answers of an experiment most likely, and finds how
// far it can be trusted (Wichmann and Hill 2001, I and II).
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
    /// Takes the lapse rate as the guess rate, instead: for "more or less?" questions.
    bool guess_is_lapse = false;
    double max_lapse = 0.05;  ///< the lapse rate is fitted within [0, max_lapse]
    /// What is known of the shape; if nothing, it is fitted. After a procedure that asks near the
    /// threshold alone it must be known: such answers make the function look steeper than it is
    /// (Kaernbach 2001), and the threshold better known.
    std::optional<double> shape = std::nullopt;
};

struct PsychometricFit {
    model::Psychometric function;
    /// Sum over trials of -ln p(answer), without the binomial coefficients.
    double negative_log_likelihood = 0;
    /// Twice the log likelihood lost to the model that has each level's share of "yes" [1]. If each
    /// level has many trials, it is about chi-squared distributed, with the number of levels less
    /// that of parameters degrees of freedom; if not, see `deviance_share()` below.
    double deviance = 0;
    /// Functions far steeper, or far flatter, than any that the levels could tell apart fit as
    /// well: the answers turn from all "no" to all "yes" between two levels, or have no trend. The
    /// shape then means nothing.
    bool shape_unknown = false;
};

/// Throws Error for fewer than two levels, for impossible counts, and for levels that are not
/// positive with Sigmoid::weibull.
PsychometricFit fit_psychometric(std::span<const LevelCount> counts,
                                 const PsychometricFitSettings& settings);

struct PsychometricIntervals {
    Interval threshold, shape, lapse;  ///< 95 %
};

/// Intervals of the profile likelihood: the values with which, the other parameters fitted anew,
/// twice the log likelihood falls by no more than 3.84. The likelihood is the same whatever chose
/// the levels, so these hold after procedures that chose them by the answers, too; intervals of a
/// bootstrap at the same levels do not.
PsychometricIntervals profile_intervals(std::span<const LevelCount> counts,
                                        const PsychometricFit& fit,
                                        const PsychometricFitSettings& settings);

/// Share of the resamples of a parametric bootstrap that fit no better than the data did: below
/// 0.05 the model does not describe the data. `resamples` times, the fitted function answers as
/// many trials at the same levels, and these answers are fitted.
double deviance_share(std::span<const LevelCount> counts, const PsychometricFit& fit,
                      const PsychometricFitSettings& settings, int resamples, uint64_t seed);

}  // namespace dihaptic::analysis
