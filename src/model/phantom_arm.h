// Kinematics and dynamics of the arm of a PHANToM Premium: a turret, and a thigh and a shin that
// are driven from the turret through a parallelogram.
//
// Joint angles q = (turret, thigh, shin) are zero in the reset pose, in which the thigh is level
// and points toward the person, and the shin hangs at a right angle to the thigh. Positive angles
// turn the turret to the right, and the thigh and shin up; the shin's angle is measured from the
// vertical. The device's frame D has its origin at the endpoint in the reset pose, with x to the
// right, y up and z toward the person. README.md gives the equations.
#pragma once

#include "base/geometry.h"
#include "model/phantom_links.h"

namespace dihaptic::model {

/// Limits of the joint angles [rad]. The limits of the difference between the thigh's and the
/// shin's angle are known for a Premium 1.5; the others are guesses that are consistent with
/// pictures of the device.
struct PhantomLimits {
    Vec3 low;
    Vec3 high;
    double bend_low;  ///< limits of the thigh's angle minus the shin's angle
    double bend_high;
};
const PhantomLimits& phantom_limits();

/// Returns p_DH for given joint angles [m].
Vec3 phantom_position(const PhantomLinks& links, const Vec3& q) noexcept;
/// Returns the Jacobian J [m], where v_DH = J dq/dt, so that the joint torques are J^T f_D.
Mat3 phantom_jacobian(const PhantomLinks& links, const Vec3& q) noexcept;
/// Returns the acceleration of the endpoint at constant joint rates: dJ/dt q' [m/s^2].
Vec3 phantom_steady_acceleration(const PhantomLinks& links, const Vec3& q,
                                 const Vec3& rate) noexcept;
/// Returns |det J| = l1 l2 rho cos(q2 - q3) [m^3], where rho is the distance of the endpoint from
/// the turret's axis. Where the determinant vanishes, the arm cannot exert forces in all
/// directions.
double phantom_determinant(const PhantomLinks& links, const Vec3& q) noexcept;
/// Returns the joint angles for which the endpoint is at p_DH or, where the links cannot reach
/// p_DH, at the nearest point on the line from the shoulder to p_DH.
Vec3 phantom_joints(const PhantomLinks& links, const Vec3& p_DH) noexcept;
/// Whether the joint angles are within the limits.
bool phantom_allows(const Vec3& q) noexcept;
/// Whether the endpoint can reach p_DH within the joint limits.
bool phantom_reaches(const PhantomLinks& links, const Vec3& p_DH) noexcept;

/// Coefficients of M(q) q'' + C(q, q') + G(q) + damping q' = joint torques, summed over the arm's
/// parts.
struct PhantomDynamics {
    // M11 = m0 + m_thigh cos 2q2 + m_shin cos 2q3 + m_both cos q2 sin q3 [kg*m^2]
    double m0 = 0;
    double m_thigh = 0;
    double m_shin = 0;
    double m_both = 0;  // and M23 = -m_both / 2 sin(q2 - q3)
    double m22 = 0;
    double m33 = 0;
    // G2 = g_thigh cos q2, G3 = g_shin sin q3 [N*m]
    double g_thigh = 0;
    double g_shin = 0;
    double damping = 0;  ///< damping of each joint [N*m*s]

    /// The Premium 1.5 without its rotors, using published values.
    static PhantomDynamics premium_1_5();
    /// The Premium 1.5 scaled to other link lengths: masses are proportional to the lengths, and
    /// inertias to the cubes of the lengths. No values have been published for the parts of a
    /// Premium 1.0.
    static PhantomDynamics scaled(const PhantomLinks& links);
};

/// M(q) [kg*m^2].
Mat3 phantom_mass_matrix(const PhantomDynamics& arm, const Vec3& q) noexcept;
/// Returns C(q, q'), computed from the Christoffel symbols of M [N*m].
Vec3 phantom_coriolis(const PhantomDynamics& arm, const Vec3& q, const Vec3& rate) noexcept;
/// G(q) [N*m].
Vec3 phantom_gravity(const PhantomDynamics& arm, const Vec3& q) noexcept;
/// Returns the sum of kinetic and potential energy; the potential energy is zero in the reset pose
/// [J].
double phantom_energy(const PhantomDynamics& arm, const Vec3& q, const Vec3& rate) noexcept;

}  // namespace dihaptic::model
