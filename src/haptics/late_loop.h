// Limits what a loop with late ticks may render: the stiffness of a coupling, and the rate at which
// its force may rise.
//
// Suppose that the force of a spring k and its damper k h / 2 is held from one tick to the next, a
// time T_i later, while the handle moves at v. This gives the handle energy that neither side
// supplied, k v^2 T_i (T_i - h) / 2: the damper compensates for the hold of a punctual tick, h, but
// not for lateness. A handle and hand with damping b absorb b v^2 T_i. On average the loop
// therefore generates no energy as long as
//
//     k <= 2 b / L,        L = sum T_i (T_i - h) / sum T_i,
//
// where L is the mean lateness, weighted by the duration of each interval (servo/lateness.h
// measures it). Only the fraction kHeldShare of this stiffness is used: README.md compares it with
// the limit at which a sampled loop actually starts to shake.
#pragma once

#include <limits>

#include "frame/haptics_settings.h"
#include "model/grasp.h"

namespace dihaptic::haptics {

/// Damping of handle and hand if unknown: that of a loose hand [N*s/m].
constexpr double kLooseDamping = 1;
/// Fraction of 2 b / L that is used: loops that include the mass of a handle become unstable
/// slightly below this limit.
constexpr double kHeldShare = 0.7;
/// If a loop can hold only a stiffness below this, force is switched off [N/m].
constexpr double kLeastHeld = 100;

/// Stiffness that a loop with a mean lateness of `lateness` [s] can hold if handle and hand have
/// the damping b [N*s/m]; infinite if the loop is not late [N/m].
inline double held_stiffness(double b, double lateness) noexcept {
    return lateness > 0 ? kHeldShare * model::passive_stiffness(b, lateness)
                        : std::numeric_limits<double>::infinity();
}

/// Returns the settings reduced to the limits of the loop. Values within the limits are unchanged,
/// so that softening twice has the same effect as softening once. `tick` is in [s].
frame::CouplingSettings softened(frame::CouplingSettings asked, double b, double lateness,
                                 double tick) noexcept;

/// Returns the part of a force that may follow `last` after the handle has `moved`: it may rise
/// like the force of a spring of stiffness k, plus `creep`, and may fall freely. A stiffer spring
/// would keep rising in late ticks, with each force farther from the last one; a force held at rest
/// does not change. Can also be used for a torque and a rotation.
Vec3 bound_rise(const Vec3& asked, const Vec3& last, const Vec3& moved, double k,
                double creep) noexcept;

/// For bound_rise(): speed at which the other end of the spring may follow [m/s], and the same for
/// rotations [rad/s]. A faster end would feed energy to a swinging hand.
constexpr double kCreep = 0.2e-3;
constexpr double kTurnCreep = 4e-3;
/// Ratio of the rotational to the translational stiffness that can be held, which is the ratio of
/// the hand's two dampings (0.02 N*m*s/rad and 3 N*s/m) [m^2].
constexpr double kTurnHeld = 0.02 / 3;

}  // namespace dihaptic::haptics
