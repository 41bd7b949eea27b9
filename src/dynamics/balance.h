// The balance of a step, which Books computes and frames record.
#pragma once

namespace dihaptic::dynamics {

/// Covers the scene's freely moving bodies; fingers and driven bodies act from outside. From step
/// to step, kinetic + potential changes by work - dissipated + energy_imbalance.
struct Balance {
    double kinetic = 0;             ///< [J]
    double potential = 0;           ///< of weights, 0 at the world's origin, and of springs [J]
    double work = 0;                ///< in the step, by fingers, loads, motors, and set states [J]
    double dissipated = 0;          ///< in the step, by friction, dampers and impacts [J]
    double energy_imbalance = 0;    ///< in the step, of unexplained origin [J]
    double momentum_imbalance = 0;  ///< in the step, the largest that no force explains [N*s]
    double angular_imbalance = 0;   ///< likewise, for angular momentum [N*m*s]
    bool unbalanced =
        false;  ///< whether an imbalance exceeds the effect of rounding and the finite step

    double energy() const noexcept { return kinetic + potential; }
};

}  // namespace dihaptic::dynamics
