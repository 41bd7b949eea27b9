// Limits the rendering of a loop with late ticks: the stiffness of a coupling, and the rate of rise
// of force.
//
// A spring k and its damper k h / 2, held from one tick to the next a time T_i later while the
// handle moves at v, give the handle energy that neither side put in, k v^2 T_i (T_i - h) / 2: the
// damper compensates for the hold of a punctual tick, h, but not for lateness. A handle and a hand
// of damping b absorb b v^2 T_i. On average the loop therefore generates no energy as long as
//
//     k <= 2 b / L,        L = sum T_i (T_i - h) / sum T_i,
//
// where L is the mean lateness, each interval weighted by its duration (servo/lateness.h measures
// it). README.md compares this with the limit at which a sampled loop really starts to shake;
// therefore only the fraction kHeldShare is used.
#pragma once

#include <limits>

#include "frame/haptics_settings.h"
#include "model/grasp.h"

namespace dihaptic::haptics {

/// Damping of handle and hand if unknown: a loose hand's [N*s/m].
constexpr double kLooseDamping = 1;
/// Fraction of 2 b / L used: loops with a handle's mass become unstable slightly below the limit.
constexpr double kHeldShare = 0.7;
/// Force is switched off if a loop can hold only a stiffness below this [N/m].
constexpr double kLeastHeld = 100;

/// Stiffness that a loop with mean lateness L [s] can hold, with damping b of handle and hand
/// [N*s/m]; infinite if the loop is in time [N/m].
inline double held_stiffness(double b, double lateness) noexcept {
    return lateness > 0 ? kHeldShare * model::passive_stiffness(b, lateness)
                        : std::numeric_limits<double>::infinity();
}

/// The settings reduced to the loop's limits; values within them are unchanged, so that softening
/// twice has the same effect as softening once. `tick` [s].
frame::CouplingSettings softened(frame::CouplingSettings asked, double b, double lateness,
                                 double tick) noexcept;

/// The part of a force that may follow `last` after the handle `moved`: it may rise like that of a
/// spring of stiffness k, plus `creep`, and may fall freely. A stiffer spring would continue
/// rising in late ticks, each force further from the last; a force held at rest does not
/// change. Also for a torque and a rotation.
Vec3 bound_rise(const Vec3& asked, const Vec3& last, const Vec3& moved, double k,
                double creep) noexcept;

/// For bound_rise(): speed at which the spring's other end may follow; a faster end would
/// feed a swinging hand [m/s], and for rotations [rad/s].
constexpr double kCreep = 0.2e-3;
constexpr double kTurnCreep = 4e-3;
/// Rotational stiffness that can be held, relative to the translational: the ratio of a hand's two
/// dampings (0.02 N*m*s/rad and 3 N*s/m) [m^2].
constexpr double kTurnHeld = 0.02 / 3;

}  // namespace dihaptic::haptics
