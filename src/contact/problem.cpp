#include "contact/problem.h"

#include <algorithm>

#include "contact/rows.h"

namespace dihaptic::contact {
namespace {

using Vec4 = Eigen::Vector4d;

/// Converts an impulse to the space of the four-dimensional cone, where the moment is divided by
/// the torsion radius.
Vec4 in_cone(const Impulse& r, const ProblemContact& contact) {
    Vec4 out = r;
    out[3] = contact.torsion_radius > 0 ? r[3] / contact.torsion_radius : 0;
    return out;
}

}  // namespace

bool ContactProblem::has_torsion() const noexcept {
    return std::any_of(contacts.begin(), contacts.end(),
                       [](const ProblemContact& contact) { return contact.torsion_radius > 0; });
}

double normal_velocity(const ContactProblem& problem, const ProblemContact& contact) noexcept {
    return free_velocity<3>(problem, contact)[0] - contact.bias;
}

double normal_mobility(const ContactProblem& problem, const ProblemContact& contact) noexcept {
    double out = 0;
    const auto add = [&](int body, const Vec3& arm) {
        if (body == kFixed) return;
        const Vec6 J = contact_row<3>(contact, arm).row(0);
        out += J.dot(problem.bodies[static_cast<size_t>(body)].inverse_mass * J);
    };
    add(contact.a, contact.p_AC_W);
    add(contact.b, contact.p_BC_W);
    return out;
}

DelassusProblem delassus(const ContactProblem& problem) {
    const auto n = static_cast<Eigen::Index>(problem.contacts.size());
    const auto m = static_cast<Eigen::Index>(problem.bodies.size());
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3 * n, 6 * m);
    Eigen::MatrixXd inverse_mass = Eigen::MatrixXd::Zero(6 * m, 6 * m);
    DelassusProblem out;
    out.q.resize(3 * n);
    out.mu.resize(n);
    for (Eigen::Index i = 0; i < m; ++i) {
        inverse_mass.block<6, 6>(6 * i, 6 * i) =
            problem.bodies[static_cast<size_t>(i)].inverse_mass;
    }
    for (Eigen::Index j = 0; j < n; ++j) {
        const ProblemContact& contact = problem.contacts[static_cast<size_t>(j)];
        if (contact.b != kFixed)
            J.block<3, 6>(3 * j, Eigen::Index{6} * contact.b) +=
                contact_row<3>(contact, contact.p_BC_W);
        if (contact.a != kFixed)
            J.block<3, 6>(3 * j, Eigen::Index{6} * contact.a) -=
                contact_row<3>(contact, contact.p_AC_W);
        out.q.segment<3>(3 * j) = free_velocity<3>(problem, contact);
        out.mu[j] = contact.friction;
    }
    out.W = J * inverse_mass * J.transpose();
    for (Eigen::Index j = 0; j < n; ++j)
        out.W(3 * j, 3 * j) += problem.contacts[static_cast<size_t>(j)].compliance;
    return out;
}

double natural_map_residual(const ContactProblem& problem, std::span<const Impulse> r) {
    std::vector<Vec6> scratch(problem.bodies.size());
    return natural_map_residual(problem, r, scratch);
}

double natural_map_residual(const ContactProblem& problem, std::span<const Impulse> r,
                            std::span<Vec6> velocity) noexcept {
    std::fill(velocity.begin(), velocity.end(), Vec6::Zero());
    for (size_t j = 0; j < problem.contacts.size(); ++j) {
        const ProblemContact& contact = problem.contacts[j];
        const Vec4 impulse = in_cone(r[j], contact);
        if (contact.b != kFixed)
            velocity[static_cast<size_t>(contact.b)] +=
                contact_row<4>(contact, contact.p_BC_W).transpose() * impulse;
        if (contact.a != kFixed)
            velocity[static_cast<size_t>(contact.a)] -=
                contact_row<4>(contact, contact.p_AC_W).transpose() * impulse;
    }
    for (size_t i = 0; i < velocity.size(); ++i) {
        velocity[i] = problem.bodies[i].inverse_mass * velocity[i];
    }
    double error = 0;
    double size = 0;
    for (size_t j = 0; j < problem.contacts.size(); ++j) {
        const ProblemContact& contact = problem.contacts[j];
        const Vec4 q = free_velocity<4>(problem, contact);
        Vec4 u = q;
        if (contact.b != kFixed)
            u += contact_row<4>(contact, contact.p_BC_W) * velocity[static_cast<size_t>(contact.b)];
        if (contact.a != kFixed)
            u -= contact_row<4>(contact, contact.p_AC_W) * velocity[static_cast<size_t>(contact.a)];
        u[0] += contact.compliance * r[j][0];
        error += natural_map_squared<4>(in_cone(r[j], contact), u, contact.friction);
        size += q.squaredNorm();
    }
    return std::sqrt(error) / (1 + std::sqrt(size));
}

double natural_map_residual(const DelassusProblem& problem, const Eigen::VectorXd& r) {
    const Eigen::VectorXd u = problem.W * r + problem.q;
    double error = 0;
    for (Eigen::Index j = 0; j < problem.mu.size(); ++j) {
        error += natural_map_squared<3>(r.segment<3>(3 * j), u.segment<3>(3 * j), problem.mu[j]);
    }
    return std::sqrt(error) / (1 + problem.q.norm());
}

}  // namespace dihaptic::contact
