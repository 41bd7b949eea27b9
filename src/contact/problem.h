// The contact problem of one step is to find impulses that keep bodies from passing through each
// other, obey Coulomb's law, and hold joints together. README.md has the equations.
#pragma once

#include <Eigen/Dense>
#include <limits>
#include <span>
#include <vector>

#include "base/geometry.h"

namespace dihaptic::contact {

/// Index of a body that no impulse moves.
constexpr int kFixed = -1;

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

struct ProblemBody {
    /// Inverse mass matrix about the centre of mass, in W, for linear and then angular velocity.
    /// Symmetric, and singular if a joint holds the body (hold()) [1/kg], [1/(kg*m)], [1/(kg*m^2)].
    Mat6 inverse_mass = Mat6::Zero();
    Vec3 v_W = Vec3::Zero();  ///< velocity of the centre of mass, including the effect of all loads
                              ///< except contact [m/s]
    Vec3 w_W = Vec3::Zero();  ///< [rad/s]
};

/// Removes the motion along axis i from an inverse mass matrix: M^-1 - M^-1 e (e' M^-1 e)^-1 e'
/// M^-1, which is the inverse of M restricted to all other motions. This is the effect of a joint
/// to the world.
inline void hold(Mat6& inverse_mass, int i) noexcept {
    const Vec6 column = inverse_mass.col(i);
    if (column[i] > 0) inverse_mass -= column * column.transpose() / column[i];
    inverse_mass.row(i).setZero();
    inverse_mass.col(i).setZero();
}

struct ProblemContact {
    int a = kFixed;  ///< index into ContactProblem::bodies
    int b = kFixed;
    Vec3 p_AC_W = Vec3::Zero();  ///< vector from a's centre of mass to the contact [m]
    Vec3 p_BC_W = Vec3::Zero();
    Mat3 R_WC = Mat3::Identity();  ///< columns: unit normal from a to b, then two tangents
    double bias = 0;               ///< added to the normal velocity: gap divided by time step [m/s]
    Eigen::Vector2d slip = Eigen::Vector2d::Zero();  ///< added to the tangential velocities [m/s]
    double compliance = 0;      ///< compliance of a soft contact along the normal [m/s per N*s]
    double friction = 0;        ///< coefficient mu
    double torsion_radius = 0;  ///< limits the moment about the normal to mu r N; 0 for no moment
                                ///< [m]
};

/// Impulse exerted by a on b, in the contact frame: along the normal and two tangents [N*s], then
/// the moment about the normal [N*m*s].
using Impulse = Eigen::Vector4d;

/// Up to three rows of a joint. Each row requires the following, with u = J_a (v_a, w_a) + J_b
/// (v_b, w_b) + bias at the end of the step and r the impulse of the row:
///
///     low <= r <= high      u + compliance r  is 0 between the bounds, >= 0 at low, <= 0 at high
///
/// Without bounds and compliance, the bodies do not move relative to each other; with low = 0 the
/// row acts as a stop, with low = -high as dry friction, and with a compliance as an implicit
/// spring. A row without J and with bounds of 0 does nothing.
struct ProblemJoint {
    static constexpr int kRows = 3;
    using Rows = Eigen::Matrix<double, kRows, 6>;

    int a = kFixed;
    int b = kFixed;
    Rows J_a = Rows::Zero();  ///< for linear and then angular velocity, including the sign
    Rows J_b = Rows::Zero();
    Vec3 bias = Vec3::Zero();        ///< in [m/s] or [rad/s], like u
    Vec3 compliance = Vec3::Zero();  ///< [m/s per N*s] or [rad/s per N*m*s]
    Vec3 low = Vec3::Constant(-std::numeric_limits<double>::infinity());  ///< [N*s] or [N*m*s]
    Vec3 high = Vec3::Constant(std::numeric_limits<double>::infinity());
};

/// Bodies, contacts and joints of one step. Find impulses r so that for each contact, where u is
/// the velocity of b relative to a at the end of the step plus slip and, along the normal, plus
/// bias and compliance r_N: r_N >= 0, u_N >= 0, r_N u_N = 0, |r_T| <= mu r_N, and r_T opposite to
/// u_T if it slides; and so that the rows of each joint are satisfied.
struct ContactProblem {
    std::vector<ProblemBody> bodies;
    std::vector<ProblemContact> contacts;
    std::vector<ProblemJoint> joints;

    void clear() noexcept {
        bodies.clear();
        contacts.clear();
        joints.clear();
    }
    bool has_torsion() const noexcept;
};

/// Velocity of b relative to a along the contact normal, without impulses and without the bias
/// [m/s].
double normal_velocity(const ContactProblem& problem, const ProblemContact& contact) noexcept;
/// Change in a contact's normal velocity per unit impulse along its normal: W_NN without the
/// compliance [1/kg].
double normal_mobility(const ContactProblem& problem, const ProblemContact& contact) noexcept;

/// A contact problem without bodies, u = W r + q, with three rows per contact: normal, then two
/// tangents.
struct DelassusProblem {
    Eigen::MatrixXd W;   ///< positive semi-definite up to rounding [1/kg]
    Eigen::VectorXd q;   ///< velocities in the absence of contact impulses [m/s]
    Eigen::VectorXd mu;  ///< friction coefficient of each contact
};
/// Converts a problem to one without bodies, leaving out torsion and joints.
DelassusProblem delassus(const ContactProblem& problem);

/// Squared error |F|^2 of one contact in Coulomb's law, zero for an exact answer. F is the natural
/// map r - P_K(r - (u + mu |u_T| n)), where P_K projects onto the cone K, in any dimension (De
/// Saxce and Feng 1998; Acary, Bremond and Huber 2018).
template <int D>
double natural_map_squared(const Eigen::Matrix<double, D, 1>& r,
                           const Eigen::Matrix<double, D, 1>& u, double mu) noexcept {
    double slip = 0;
    double tangent = 0;
    for (int k = 1; k < D; ++k) {
        slip += u[k] * u[k];
        tangent += (r[k] - u[k]) * (r[k] - u[k]);
    }
    const double lifted = u[0] + mu * std::sqrt(slip);
    const double normal = r[0] - lifted;
    tangent = std::sqrt(tangent);
    if (tangent <= mu * normal) return lifted * lifted + slip;
    if (mu * tangent <= -normal) return r.squaredNorm();
    const double on_cone = (normal + mu * tangent) / (1 + mu * mu);
    const double share = mu * on_cone / tangent;
    double sum = (r[0] - on_cone) * (r[0] - on_cone);
    for (int k = 1; k < D; ++k) {
        const double miss = r[k] - share * (r[k] - u[k]);
        sum += miss * miss;
    }
    return sum;
}

/// Norm of the natural map divided by 1 + |q|, in the units of the given problem, which must not
/// have joints.
double natural_map_residual(const ContactProblem& problem, std::span<const Impulse> r);
/// The same without allocating memory: `scratch` must have as many elements as the problem has
/// bodies.
double natural_map_residual(const ContactProblem& problem, std::span<const Impulse> r,
                            std::span<Vec6> scratch) noexcept;
double natural_map_residual(const DelassusProblem& problem, const Eigen::VectorXd& r);

}  // namespace dihaptic::contact
