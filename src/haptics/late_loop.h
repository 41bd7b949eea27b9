// What a loop may render whose ticks come late: how stiff, and how fast a force may rise.
//
// A spring k and its damper k h / 2, held from a tick to the next one T_i later while the handle
// moves at v, give it energy that nobody put in, k v^2 T_i (T_i - h) / 2: the damper takes the hold
// of a tick h that is in time, and lateness is what remains. A handle and a hand of damping b take
// b v^2 T_i. So over a while the loop gives out nothing as long as
//
//     k <= 2 b / L,        L = sum T_i (T_i - h) / sum T_i,
//
// L being the mean lateness, each interval counted by its length (servo/lateness.h measures it).
// README.md compares this with where a sampled loop really begins to shake, and so takes kHeldShare
// of it.
#pragma once

#include <limits>

#include "haptics/settings.h"
#include "model/grasp.h"

namespace dihaptic::haptics {

/// Damping of handle and hand where nobody knows better: of a hand that holds loosely [N*s/m].
constexpr double kLooseDamping = 1;
/// Of 2 b / L, which loops with the mass of a handle do not quite hold.
constexpr double kHeldShare = 0.7;
/// A loop that holds less than this renders nothing that is worth its force [N/m].
constexpr double kLeastHeld = 100;

/// Stiffness that a loop holds which comes late by L [s], with damping b [N*s/m] of handle and
/// hand; infinite when it is in time [N/m].
inline double held_stiffness(double b, double lateness) noexcept {
    return lateness > 0 ? kHeldShare * model::passive_stiffness(b, lateness)
                        : std::numeric_limits<double>::infinity();
}

/// No more of each than is held: what is asked for already stays as it is, so that this done twice
/// is the same as once. `tick` [s].
CouplingSettings softened(CouplingSettings asked, double b, double lateness, double tick) noexcept;

/// The part of a force that may follow on `last` after the handle `moved`: its rise is that of a
/// spring of stiffness k, and no more than `creep` where the handle rests. Falling is free. Where a
/// stiffer spring had gone on rising, in late ticks each force is farther off than the one before;
/// this leaves what is held at rest as it is. The same for a torque, and a turn.
Vec3 bound_rise(const Vec3& asked, const Vec3& last, const Vec3& moved, double k,
                double creep) noexcept;

/// Of bound_rise(): so fast the spring's other end may follow. Faster, it would feed a hand that
/// swings [m/s]; as turning [rad/s].
constexpr double kCreep = 0.2e-3;
constexpr double kTurnCreep = 4e-3;
/// Held stiffness against turning, as a share of that against moving: what a hand's two dampings
/// are (0.02 N*m*s/rad and 3 N*s/m) [m^2].
constexpr double kTurnHeld = 0.02 / 3;

}  // namespace dihaptic::haptics
