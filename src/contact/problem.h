// The contact problem of one step: which impulses keep bodies from passing through each other and
// obey Coulomb's law. README.md has the equations.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "base/geometry.h"

namespace dihaptic::contact {

/// Stands for a body that no impulse moves.
constexpr int kFixed = -1;

struct ProblemBody {
    Mat3 inverse_mass;        ///< in W; symmetric; may differ by direction; zero where held [1/kg]
    Mat3 inverse_inertia;     ///< about the centre of mass, in W [1/(kg*m^2)]
    Vec3 v_W = Vec3::Zero();  ///< of the centre of mass, with all loads but contact [m/s]
    Vec3 w_W = Vec3::Zero();  ///< [rad/s]
};

struct ProblemContact {
    int a = kFixed;  ///< index into bodies
    int b = kFixed;
    Vec3 p_AC_W = Vec3::Zero();  ///< from a's centre of mass to the contact [m]
    Vec3 p_BC_W = Vec3::Zero();
    Mat3 R_WC = Mat3::Identity();  ///< columns: unit normal from a to b, two tangents
    double bias = 0;               ///< added to the normal velocity: gap over time step [m/s]
    double friction = 0;           ///< coefficient mu
    double torsion_radius = 0;     ///< a moment about the normal up to mu r N; 0: none [m]
};

/// Impulse of a on b in the contact's frame: normal, two tangents [N*s], moment about the normal
/// [N*m*s].
using Impulse = Eigen::Vector4d;

/// Bodies and contacts of one step. Find impulses r so that for each contact, with
/// u = velocity of b relative to a + bias along the normal, at the end of the step:
/// 0 <= r_N, u_N >= 0, r_N u_N = 0, |r_T| <= mu r_N, and r_T against u_T where it slides.
struct ContactProblem {
    std::vector<ProblemBody> bodies;
    std::vector<ProblemContact> contacts;

    void clear() noexcept {
        bodies.clear();
        contacts.clear();
    }
    bool has_torsion() const noexcept;
};

/// The same problem without bodies, three rows a contact: normal, then two tangents. u = W r + q.
struct DelassusProblem {
    Eigen::MatrixXd W;   ///< positive semi-definite up to rounding [1/kg]
    Eigen::VectorXd q;   ///< velocities without contact impulses [m/s]
    Eigen::VectorXd mu;  ///< by contact
};
/// Contacts without torsion.
DelassusProblem delassus(const ContactProblem& problem);

/// Projection on the Coulomb cone { r : |r_T| <= mu r_N } of any dimension.
template <int D>
Eigen::Matrix<double, D, 1> project_on_cone(const Eigen::Matrix<double, D, 1>& x,
                                            double mu) noexcept {
    const double tangent = x.template tail<D - 1>().norm();
    if (tangent <= mu * x[0]) return x;
    if (mu * tangent <= -x[0]) return Eigen::Matrix<double, D, 1>::Zero();
    const double normal = (x[0] + mu * tangent) / (1 + mu * mu);
    Eigen::Matrix<double, D, 1> out;
    out[0] = normal;
    out.template tail<D - 1>() = mu * normal / tangent * x.template tail<D - 1>();
    return out;
}

/// What one contact misses of Coulomb's law: r - P_K(r - (u + mu |u_T| n)), zero when it holds
/// (De Saxce and Feng 1998; Acary, Bremond and Huber 2018).
template <int D>
Eigen::Matrix<double, D, 1> natural_map(const Eigen::Matrix<double, D, 1>& r,
                                        const Eigen::Matrix<double, D, 1>& u, double mu) noexcept {
    Eigen::Matrix<double, D, 1> x = r - u;
    x[0] -= mu * u.template tail<D - 1>().norm();
    return r - project_on_cone<D>(x, mu);
}

/// Norm of the natural map over 1 + |q|, of the problem as given.
double natural_map_residual(const ContactProblem& problem, std::span<const Impulse> r);
/// The same without allocating: `scratch` has as many elements as the problem has bodies.
double natural_map_residual(const ContactProblem& problem, std::span<const Impulse> r,
                            std::span<Eigen::Matrix<double, 6, 1>> scratch) noexcept;
double natural_map_residual(const DelassusProblem& problem, const Eigen::VectorXd& r);

}  // namespace dihaptic::contact
