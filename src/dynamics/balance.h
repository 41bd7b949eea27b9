// The momentum and energy balance of a step, which is computed by Books and recorded in frames.
#pragma once

namespace dihaptic::dynamics {

/// Covers the scene's freely moving bodies; fingers and driven bodies act on them from outside.
/// From one step to the next, kinetic + potential changes by work - dissipated + energy_imbalance.
struct Balance {
    double kinetic = 0;             ///< [J]
    double potential = 0;           ///< of weights (0 at the world's origin) and springs [J]
    double work = 0;                ///< done in the step by fingers, loads, motors and set states
                                    ///< [J]
    double dissipated = 0;          ///< lost in the step to friction, dampers and impacts [J]
    double energy_imbalance = 0;    ///< gained in the step from an unknown source [J]
    double momentum_imbalance = 0;  ///< largest change in the step that no force explains [N*s]
    double angular_imbalance = 0;   ///< the same for angular momentum [N*m*s]
    bool unbalanced =
        false;  ///< whether an imbalance is larger than rounding and the finite step can explain

    double energy() const noexcept { return kinetic + potential; }
};

}  // namespace dihaptic::dynamics
