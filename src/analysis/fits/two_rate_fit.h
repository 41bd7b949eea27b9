// Fits the two-rate model (model/adaptation.h) to a person's compensation in each trial: finds the
// globally least sum of squared residuals within
//
//     0 <= A_fast <= A_slow <= 1        0 <= B_slow <= B_fast <= 1
//
// and profile intervals of the parameters. The result does not depend on the choice of a starting
// point, because the search evaluates a lattice over the whole space and runs Levenberg-Marquardt
// from the best lattice points.
#pragma once

#include <span>

#include "analysis/fits/adaptation_fit.h"

namespace dihaptic::analysis {

struct TwoRateFit : CurveFit {
    model::TwoRate rates;
    Interval retention_fast, learning_fast, retention_slow, learning_slow;  ///< 95 %
};

/// `measured`: compensation in each of `trials`, NaN where not measured. Throws Error when the
/// sizes of `measured` and `trials` differ, or when fewer than five trials were measured.
TwoRateFit fit_two_rate(std::span<const double> measured,
                        std::span<const model::AdaptationTrial> trials);

/// Returns the sum of squared residuals of the model found by descending from a single starting
/// point. Tests use it to judge the search.
double squares_downhill(std::span<const double> measured,
                        std::span<const model::AdaptationTrial> trials,
                        const model::TwoRate& start);

}  // namespace dihaptic::analysis
