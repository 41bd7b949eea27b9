// The exponential learning curve
//
//     y(n) = y_end + (y_0 - y_end) exp(-n / tau)
//
// where n counts trials from 0. A single-rate process (model/adaptation.h) under a lasting
// perturbation f follows this curve exactly, with y_0 = 0, y_end = f B / (1 - A + B) and tau = -1 /
// ln(A - B), as long as 0 < A - B < 1.
#pragma once

#include <cmath>

#include "model/adaptation.h"

namespace dihaptic::model {

struct LearningCurve {
    double start = 0;          ///< y_0
    double asymptote = 0;      ///< y_end
    double time_constant = 1;  ///< tau [trials]

    double at(double trial) const {
        return asymptote + (start - asymptote) * std::exp(-trial / time_constant);
    }
};

/// Returns the learning curve of a single-rate process under a perturbation that starts in trial 0
/// and does not end.
inline LearningCurve learning_curve(const SingleRate& rate, double perturbation) {
    return {0, perturbation * asymptote(rate), -1 / std::log(rate.retention - rate.learning)};
}

}  // namespace dihaptic::model
