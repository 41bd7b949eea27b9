// Fits learning curves (model/learning_curve.h) and single-rate adaptation (model/adaptation.h) to
// a person's compensation in each trial, by least squares. Computes the profile interval of each
// parameter, i.e. the values for which, with all other parameters refitted,
//
//     (n - p) ln(SSE / SSE_min) <= 3.84
//
// where n is the number of measured trials, p is the number of parameters and SSE is the sum of
// squared residuals. The two-rate model is fitted in two_rate_fit.h.
#pragma once

#include <span>
#include <vector>

#include "analysis/fits/minimise.h"
#include "model/adaptation.h"
#include "model/learning_curve.h"

namespace dihaptic::analysis {

/// Results common to all fits. Predictions exist for every trial, measured or not.
struct CurveFit {
    std::vector<double> predicted;
    double mean_square = 0;  ///< SSE / n, in squared units of the data
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
/// searched for between 0.1 trials and ten times the number of trials. All fits throw Error when
/// the number of measured trials is less than the number of parameters + 1.
LearningCurveFit fit_learning_curve(std::span<const double> measured);

/// `measured`: compensation in each of `trials`, NaN where not measured. Throws Error when the
/// sizes of `measured` and `trials` differ.
SingleRateFit fit_single_rate(std::span<const double> measured,
                              std::span<const model::AdaptationTrial> trials);

/// Throws Error when the sizes of `measured` and `trials` differ.
void check_numbers(std::span<const double> measured,
                   std::span<const model::AdaptationTrial> trials);

}  // namespace dihaptic::analysis
