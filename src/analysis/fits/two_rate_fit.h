// The two-rate model (model/adaptation.h) that is nearest to what a person did in each trial, of
// all that there are: the least sum of squared residuals within
//
//     0 <= A_fast <= A_slow <= 1        0 <= B_slow <= B_fast <= 1
//
// and profile intervals of its parameters. The search has no start that it could depend on: a
// lattice over all of the space, and Levenberg-Marquardt from the best of its points.
#pragma once

#include <span>

#include "analysis/fits/adaptation_fit.h"

namespace dihaptic::analysis {

struct TwoRateFit : CurveFit {
    model::TwoRate rates;
    Interval retention_fast, learning_fast, retention_slow, learning_slow;  ///< 95 %
};

/// `measured`: compensation in each of the trials, NaN where there is none. Throws Error when their
/// numbers differ, or when fewer than five trials were measured.
TwoRateFit fit_two_rate(std::span<const double> measured,
                        std::span<const model::AdaptationTrial> trials);

/// The sum of squared residuals of the nearest model that is found downhill from one start: what
/// the search is judged by.
double squares_downhill(std::span<const double> measured,
                        std::span<const model::AdaptationTrial> trials,
                        const model::TwoRate& start);

}  // namespace dihaptic::analysis
