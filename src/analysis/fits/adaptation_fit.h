// Fits learning curves (model/learning_curve.h) and single-rate adaptation (model/adaptation.h) to
// a person's compensation in each trial, by least squares, with profile intervals: for each
// parameter, the values at which, with all others refitted,
//
//     (n - p) ln(SSE / SSE_min) <= 3.84
//
// with n measured trials, p parameters, and SSE the sum of squared residuals. The two-rate model is
// fitted in two_rate_fit.h.
#pragma once

#include <span>
#include <vector>

#include "analysis/fits/minimise.h"
#include "model/adaptation.h"
#include "model/learning_curve.h"

namespace dihaptic::analysis {

/// Results of every fit. Predictions are for every trial, measured or not.
struct CurveFit {
    std::vector<double> predicted;
    double mean_square = 0;  ///< SSE / n, in the square of the data's unit
    double residual_sd = 0;  ///< sqrt(SSE / (n - p))
};

struct LearningCurveFit : CurveFit {
    model::LearningCurve curve;
    Interval start, asymptote, time_constant;  ///< 95 %
};

struct SingleRateFit : CurveFit {
    model::SingleRate rate;
    Interval retention, learning;  ///< 95 %
};

/// `measured`: compensation in trials 0, 1, 2, ..., NaN where not measured. The time constant is
/// sought between 0.1 trials and ten times the number of trials. All fits throw Error when fewer
/// trials than parameters + 1 were measured.
LearningCurveFit fit_learning_curve(std::span<const double> measured);

/// `measured`: compensation in each of `trials`, NaN where not measured. Throws Error when their
/// sizes differ.
SingleRateFit fit_single_rate(std::span<const double> measured,
                              std::span<const model::AdaptationTrial> trials);

/// Throws Error when the sizes differ.
void check_numbers(std::span<const double> measured,
                   std::span<const model::AdaptationTrial> trials);

}  // namespace dihaptic::analysis
