// Fits the psychometric function that makes the answers of an experiment most likely, and estimates
// its reliability (Wichmann and Hill 2001, I and II).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/fits/minimise.h"
#include "model/psychometric.h"

namespace dihaptic::analysis {

/// Counts of the answers in all trials at one level.
struct LevelCount {
    double level = 0;
    int yes = 0;
    int trials = 0;
};

struct Answer {
    double level = 0;
    bool yes = false;
};

/// Counts the answers at each level, in ascending order of level. Levels that differ only by
/// rounding are treated as one.
std::vector<LevelCount> count(std::span<const Answer> answers);

struct PsychometricFitSettings {
    model::Sigmoid sigmoid = model::Sigmoid::normal;
    double guess = 0.5;
    /// Uses the lapse rate as the guess rate, as is appropriate for "more or less?" questions.
    bool guess_is_lapse = false;
    double max_lapse = 0.05;  ///< upper limit for the fitted lapse rate, which is at least 0
    /// The shape, if it is known; if unset, it is fitted. The shape must be known after a procedure
    /// that asks only near the threshold: answers near the threshold make the function look
    /// steeper, and the threshold more certain, than they are (Kaernbach 2001).
    std::optional<double> shape = std::nullopt;
};

struct PsychometricFit {
    model::Psychometric function;
    /// Sum over trials of -ln p(answer), without the binomial coefficients.
    double negative_log_likelihood = 0;
    /// Twice the log likelihood that is lost relative to the saturated model, in which each level
    /// has its own probability of "yes" [1]. If each level has many trials, the deviance
    /// approximately follows a chi-squared distribution, with as many degrees of freedom as levels
    /// minus parameters; if not, use `deviance_share()` below.
    double deviance = 0;
    /// Whether much steeper or much flatter functions than the levels could resolve fit equally
    /// well, because the answers change from all "no" to all "yes" between two levels or have no
    /// trend. The shape is then meaningless.
    bool shape_unknown = false;
    /// Whether a function that is flat over all levels fits equally well. The threshold is then
    /// meaningless, too.
    bool flat = false;
};

/// Throws Error for fewer than two levels, for impossible counts and, with Sigmoid::weibull, for
/// levels that are not positive.
PsychometricFit fit_psychometric(std::span<const LevelCount> counts,
                                 const PsychometricFitSettings& settings);

/// The reason why a fitted threshold is not one: "yes" becomes less likely as the level rises (by
/// the Mann-Whitney test, z < -1.96), or just as likely. "" if there is no such reason.
std::string why_no_threshold(std::span<const LevelCount> counts, const PsychometricFit& fit);

struct PsychometricIntervals {
    Interval threshold, shape, lapse;  ///< 95 %
};

/// Returns profile likelihood intervals: the values for which twice the log likelihood, with the
/// other parameters refitted, falls by no more than 3.84. The likelihood does not depend on how the
/// levels were chosen, so these intervals also hold after adaptive procedures; bootstrap intervals
/// at the same levels do not.
PsychometricIntervals profile_intervals(std::span<const LevelCount> counts,
                                        const PsychometricFit& fit,
                                        const PsychometricFitSettings& settings);

/// Returns the fraction of the resamples in a parametric bootstrap that fit no better than the
/// data. If it is below 0.05, the model does not describe the data. In each resample, the fitted
/// function answers the same number of trials at each level, and the function is fitted to these
/// answers.
double deviance_share(std::span<const LevelCount> counts, const PsychometricFit& fit,
                      const PsychometricFitSettings& settings, int resamples, uint64_t seed);

}  // namespace dihaptic::analysis
