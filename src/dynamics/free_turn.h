// Solves Euler's equations exactly over one step, to find the rotation of a body that nothing
// touches.
#pragma once

#include "base/geometry.h"

namespace dihaptic::dynamics {

/// Returns the constant angular velocity, in W, that turns a body in a step of h by the same
/// rotation as its free motion from the initial w_W [rad/s]: R' = exp(h w) R is the orientation to
/// which its angular momentum leads.
///
/// `inertia` contains the principal moments of inertia [kg*m^2], about the axes of R_WM. In these
/// axes, Euler's equations
///
///     I w' = (I w) x w,    q' = q w / 2
///
/// are quadratic, so that the terms of their Taylor series follow from one another (Cauchy's
/// products; Jorba and Zou 2005). Terms are added until further ones have no effect.
Vec3 mean_velocity(const Quat& R_WM, const Vec3& inertia, const Vec3& w_W, double h) noexcept;

}  // namespace dihaptic::dynamics
