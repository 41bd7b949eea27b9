// Learning curves (model/learning_curve.h) and single-rate adaptation (model/adaptation.h) fitted
// to what a person did in each trial, by least squares, with profile intervals: for each parameter,
// those values at which, with all others fitted anew,
//
//     (n - p) ln(SSE / SSE_min) <= 3.84
//
// n measured trials, p parameters, SSE the sum of squared residuals. Two-rate: two_rate_fit.h.
#pragma once

#include <span>
#include <vector>

#include "analysis/fits/minimise.h"
#include "model/adaptation.h"
#include "model/learning_curve.h"

namespace dihaptic::analysis {

/// What all fits tell. Predictions are for every trial, measured or not.
struct CurveFit {
    std::vector<double> predicted;
    double mean_square = 0;  ///< SSE / n, in the unit of the data, squared
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

/// `measured`: compensation in trials 0, 1, 2, ..., NaN where there is none. The time constant is
/// sought between 0.1 trials and ten times their number. Throws Error when fewer trials than
/// parameters + 1 were measured, as the others do.
LearningCurveFit fit_learning_curve(std::span<const double> measured);

/// `measured`: compensation in each of the trials, NaN where there is none. Throws Error when their
/// numbers differ.
SingleRateFit fit_single_rate(std::span<const double> measured,
                              std::span<const model::AdaptationTrial> trials);

/// Throws Error when their numbers differ.
void check_numbers(std::span<const double> measured,
                   std::span<const model::AdaptationTrial> trials);

}  // namespace dihaptic::analysis
