// Contact problems for tests: some with closed-form answers, and random ones with a reference
// answer.
#pragma once

#include "base/random.h"
#include "contact/solver.h"

namespace dihaptic::contact::testing {

inline ProblemBody body(double mass, const Vec3& inertia) {
    ProblemBody out;
    out.inverse_mass.diagonal() << Vec3::Constant(1 / mass), inertia.cwiseInverse();
    return out;
}

/// Returns a frame whose first column is the normal.
inline Mat3 frame_of(const Vec3& normal) {
    Mat3 R;
    R.col(0) = normal.normalized();
    R.col(1) = R.col(0).unitOrthogonal();
    R.col(2) = R.col(0).cross(R.col(1));
    return R;
}

/// A cube with sides of 4 cm and a mass of 100 g, resting on its four lower corners on a plane with
/// normal n. Its velocity is that after a tick of gravity.
inline ContactProblem block_on_plane(const Vec3& n, double mu, double h = 1e-3) {
    const double mass = 0.1;
    const double size = 0.04;
    const Mat3 R = frame_of(n);
    ContactProblem out;
    out.bodies.push_back(body(mass, Vec3::Constant(mass * size * size / 6)));
    out.bodies[0].v_W = Vec3(0, 0, -9.81 * h);
    for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) {
            ProblemContact contact;
            contact.b = 0;
            contact.p_BC_W = size / 2 * (-R.col(0) + x * R.col(1) + y * R.col(2));
            contact.R_WC = R;
            contact.friction = mu;
            out.contacts.push_back(contact);
        }
    }
    return out;
}

/// Bodies scattered in a box that touch each other and the ground at random points: all contact
/// states occur, and W is often singular.
inline ContactProblem random_problem(Random& random, int bodies, int contacts,
                                     double torsion_radius = 0) {
    const auto vector = [&](double size) {
        return Vec3(random.uniform(-size, size), random.uniform(-size, size),
                    random.uniform(-size, size));
    };
    ContactProblem out;
    for (int i = 0; i < bodies; ++i) {
        const double mass = std::pow(10, random.uniform(-2, 0));
        out.bodies.push_back(body(mass, 2e-4 * mass * (Vec3::Ones() + 0.5 * vector(1))));
        out.bodies.back().v_W = vector(0.05) - Vec3(0, 0, 0.02);
        out.bodies.back().w_W = vector(1);
    }
    for (int j = 0; j < contacts; ++j) {
        ProblemContact contact;
        contact.b = j % bodies;
        contact.a = static_cast<int>(random.uniform(-1, bodies));
        if (contact.a == contact.b) contact.a = kFixed;
        contact.p_BC_W = vector(0.02);
        contact.p_AC_W = vector(0.02);
        contact.R_WC = frame_of(Vec3(0, 0, 1) + vector(0.5));
        contact.bias = random.uniform(0, 1) < 0.3 ? random.uniform(0, 0.02) : 0;
        contact.friction = random.uniform(0.1, 1.5);
        contact.torsion_radius = torsion_radius;
        out.contacts.push_back(contact);
    }
    return out;
}

/// Projected Gauss-Seidel on the exact cone. Each contact in turn is solved by many small projected
/// steps: slow and simple, and without sharing code with the solvers under test.
inline std::vector<Impulse> reference_solution(const ContactProblem& problem, double tolerance) {
    const DelassusProblem d = delassus(problem);
    Eigen::VectorXd r = Eigen::VectorXd::Zero(d.q.size());
    for (int sweep = 0; sweep < 200000; ++sweep) {
        for (Eigen::Index j = 0; j < d.mu.size(); ++j) {
            const double step = 0.9 / d.W.block<3, 3>(3 * j, 3 * j).norm();
            for (int i = 0; i < 10; ++i) {
                const Vec3 u = d.W.middleRows<3>(3 * j) * r + d.q.segment<3>(3 * j);
                Vec3 x = r.segment<3>(3 * j) - step * u;
                x[0] = std::max(0.0, x[0]);
                const double tangent = x.tail<2>().norm();
                if (tangent > d.mu[j] * x[0]) x.tail<2>() *= d.mu[j] * x[0] / tangent;
                r.segment<3>(3 * j) = x;
            }
        }
        if (sweep % 50 == 0 && natural_map_residual(d, r) < tolerance) break;
    }
    std::vector<Impulse> out(problem.contacts.size(), Impulse::Zero());
    for (size_t j = 0; j < out.size(); ++j)
        out[j].head<3>() = r.segment<3>(3 * static_cast<Eigen::Index>(j));
    return out;
}

/// The impulses and the statistics of a solve from a cold start.
struct Answer {
    std::vector<Impulse> r;
    std::vector<Vec3> joints;
    std::vector<Eigen::Matrix<double, 6, 1>> change;  ///< changes in the bodies' velocities
    SolveStats stats;
    SolveDetail detail;
};
inline Answer answer(Solver solver, const ContactProblem& problem, PolygonSettings polygon = {}) {
    ContactSolvers solvers;
    solvers.reserve(static_cast<int>(problem.bodies.size()),
                    static_cast<int>(problem.contacts.size()), problem.has_torsion(),
                    static_cast<int>(problem.joints.size()));
    Answer out;
    out.r.assign(problem.contacts.size(), Impulse::Zero());
    out.joints.assign(problem.joints.size(), Vec3::Zero());
    solvers.solve(solver, {polygon, {}, kUnbounded}, problem, out.r, out.joints, out.stats,
                  &out.detail);
    for (size_t i = 0; i < problem.bodies.size(); ++i)
        out.change.push_back(solvers.velocity_change(static_cast<int>(i)));
    return out;
}

}  // namespace dihaptic::contact::testing
