// Computes a contact's relative velocity from the velocities of its bodies; used by all solvers.
#pragma once

#include "contact/problem.h"

namespace dihaptic::contact {

template <int D>
using Row = Eigen::Matrix<double, D, 6>;

/// Returns J, where u = J (v, w), v is the velocity of a body's centre of mass and w is its angular
/// velocity. The caller applies the sign, which differs between a and b. For D = 4, the fourth row
/// is the spin about the normal times the torsion radius, so that a soft finger's elliptic limit
/// surface is a Coulomb cone with one more dimension.
template <int D>
Row<D> contact_row(const ProblemContact& contact, const Vec3& arm) noexcept {
    Row<D> J;
    J.template topLeftCorner<3, 3>() = contact.R_WC.transpose();
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 turn = arm.cross(contact.R_WC.col(axis));
        J.template block<1, 3>(axis, 3) = turn.transpose();
    }
    if constexpr (D == 4) {
        J.template block<1, 3>(3, 0).setZero();
        J.template block<1, 3>(3, 3) = contact.torsion_radius * contact.R_WC.col(0).transpose();
    }
    return J;
}

/// Computes u without contact impulses but including the bias.
template <int D>
Eigen::Matrix<double, D, 1> free_velocity(const ContactProblem& problem,
                                          const ProblemContact& contact) noexcept {
    Eigen::Matrix<double, D, 1> u = Eigen::Matrix<double, D, 1>::Zero();
    const auto add = [&](int index, const Vec3& arm, double sign) {
        if (index == kFixed) return;
        const ProblemBody& body = problem.bodies[static_cast<size_t>(index)];
        Vec6 velocity;
        velocity << body.v_W, body.w_W;
        u += sign * (contact_row<D>(contact, arm) * velocity);
    };
    add(contact.b, contact.p_BC_W, 1);
    add(contact.a, contact.p_AC_W, -1);
    u[0] += contact.bias;
    u.template segment<2>(1) += contact.slip;
    return u;
}

}  // namespace dihaptic::contact
