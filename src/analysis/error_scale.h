// Infers adaptation from errors: if the display is true and no channel measures force, as with a
// mass that differs by direction, the uncompensated part is visible in the movement itself,
//
//     y(n) = c + k (p(n) - x(n)) + noise
//
// with p(n) the share of the perturbation that acts, x(n) the share that is compensated for (by a
// single-rate process, model/adaptation.h), k the error of a person who has learned nothing, and c
// the error without a perturbation. c and k are chosen so that the best such process has the
// smallest sum of squares; then x(n) = p(n) - (y(n) - c) / k for each trial.
#pragma once

#include <optional>
#include <span>

#include "model/adaptation.h"

namespace dihaptic::analysis {

struct ErrorScale {
    double offset = 0;          ///< c
    double effect = 0;          ///< k
    double standard_error = 0;  ///< standard error of k, with the process held fixed

    double compensation(double share, double error) const {
        return share - (error - offset) / effect;
    }
};

/// `errors`: y in each of `trials`, NaN where not measured; `trials` have shares as perturbations.
/// Nullopt if fewer than ten were measured, or k is less than 3.5 times its standard error: the
/// error then does not show the perturbation.
std::optional<ErrorScale> scale_of_errors(std::span<const double> errors,
                                          std::span<const model::AdaptationTrial> trials);

}  // namespace dihaptic::analysis
