// Infers adaptation from errors. If the display is veridical and no channel measures force, as with
// a mass that depends on the direction, the uncompensated part of the perturbation is visible in
// the movement itself:
//
//     y(n) = c + k (p(n) - x(n)) + noise
//
// where p(n) is the fraction of the perturbation that acts, x(n) is the fraction that is
// compensated for (by a single-rate process, model/adaptation.h), k is the error of a person who
// has learned nothing, and c is the error without a perturbation. c and k are chosen so that the
// best such process has the smallest sum of squares; then x(n) = p(n) - (y(n) - c) / k for each
// trial.
#pragma once

#include <optional>
#include <span>

#include "model/adaptation.h"

namespace dihaptic::analysis {

struct ErrorScale {
    double offset = 0;          ///< c
    double effect = 0;          ///< k
    double standard_error = 0;  ///< standard error of k, for the given process

    double compensation(double share, double error) const {
        return share - (error - offset) / effect;
    }
};

/// `errors`: y for each of `trials`, NaN where not measured. The perturbations in `trials` must be
/// fractions. Returns nullopt if fewer than ten errors were measured or if k is less than 3.5 times
/// its standard error, because the error then does not show the perturbation.
std::optional<ErrorScale> scale_of_errors(std::span<const double> errors,
                                          std::span<const model::AdaptationTrial> trials);

}  // namespace dihaptic::analysis
