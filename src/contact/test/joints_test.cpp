// Tests joints in the contact problem: against the linear equations of mechanisms, against closed
// forms of springs, stops and dry friction, and in combination with contacts.
#include <gtest/gtest.h>

#include "base/unit.h"
#include "contact/rows.h"
#include "contact/test/problems.h"
#include "testing/allocation_guard.h"

namespace dihaptic::contact::joints_test {
namespace {

using testing::Answer;
using testing::answer;
using testing::block_on_plane;
using testing::body;
using testing::random_problem;

class JointsOfEach : public ::testing::TestWithParam<Solver> {};
INSTANTIATE_TEST_SUITE_P(Contact, JointsOfEach,
                         ::testing::Values(Solver::stewart_trinkle, Solver::staggered_projections,
                                           Solver::newton),
                         [](const auto& which) {
                             return std::string(
                                 enum_names(Solver{})[static_cast<size_t>(which.param)]);
                         });

Vec3 random_vector(Random& random, double size) {
    return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

/// A joint that keeps a point of b at a point of a.
ProblemJoint ball(int a, int b, const Vec3& arm_a, const Vec3& arm_b) {
    const ProblemContact frame;  // frame with the world's axes
    ProblemJoint out;
    out.a = a;
    out.b = b;
    out.J_b = contact_row<3>(frame, arm_b);
    out.J_a = -contact_row<3>(frame, arm_a);
    return out;
}

/// A joint with the given number of rows that prevent relative rotation of two bodies.
ProblemJoint turns(int a, int b, const Mat3& R, int rows) {
    ProblemJoint out;
    out.a = a;
    out.b = b;
    out.low.tail(3 - rows).setZero();
    out.high.tail(3 - rows).setZero();
    out.J_b.block(0, 3, rows, 3) = R.transpose().topRows(rows);
    out.J_a = -out.J_b;
    return out;
}

/// A joint with one row along x between a body and the world.
ProblemJoint along_x(int b) {
    ProblemJoint out;
    out.b = b;
    out.J_b(0, 0) = 1;
    out.low.tail<2>().setZero();
    out.high.tail<2>().setZero();
    return out;
}

/// A chain of bodies linked by hinges, the first of which is joined to the world. Some bodies can
/// turn about any axis, some about none.
ContactProblem mechanism(Random& random, int bodies) {
    ContactProblem out = random_problem(random, bodies, 0);
    for (int i = 0; i < bodies; ++i) {
        out.joints.push_back(
            ball(i - 1, i, random_vector(random, 0.05), random_vector(random, 0.05)));
        out.joints.back().bias = random_vector(random, 0.01);
        const auto rows = static_cast<int>(random.uniform(0, 4));
        out.joints.push_back(turns(i - 1, i, testing::frame_of(random_vector(random, 1)), rows));
    }
    return out;
}

Eigen::VectorXd stacked(const std::vector<Vec6>& of) {
    Eigen::VectorXd out(6 * static_cast<Eigen::Index>(of.size()));
    for (size_t i = 0; i < of.size(); ++i) out.segment<6>(6 * static_cast<Eigen::Index>(i)) = of[i];
    return out;
}

/// The velocity changes that follow from the linear equations J M^-1 J' r + (J v + bias) = 0, with
/// the smallest impulses.
Eigen::VectorXd exact_change(const ContactProblem& problem) {
    const auto m = static_cast<Eigen::Index>(problem.bodies.size());
    const auto n = static_cast<Eigen::Index>(problem.joints.size());
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3 * n, 6 * m);
    Eigen::MatrixXd inverse_mass = Eigen::MatrixXd::Zero(6 * m, 6 * m);
    Eigen::VectorXd v(6 * m), bias(3 * n);
    for (Eigen::Index i = 0; i < m; ++i) {
        const ProblemBody& b = problem.bodies[static_cast<size_t>(i)];
        inverse_mass.block<6, 6>(6 * i, 6 * i) = b.inverse_mass;
        v.segment<6>(6 * i) << b.v_W, b.w_W;
    }
    for (Eigen::Index j = 0; j < n; ++j) {
        const ProblemJoint& joint = problem.joints[static_cast<size_t>(j)];
        if (joint.a != kFixed) J.block<3, 6>(3 * j, Eigen::Index{6} * joint.a) += joint.J_a;
        J.block<3, 6>(3 * j, Eigen::Index{6} * joint.b) += joint.J_b;
        bias.segment<3>(3 * j) = joint.bias;
    }
    const Eigen::MatrixXd W = J * inverse_mass * J.transpose();
    const Eigen::VectorXd r = W.completeOrthogonalDecomposition().solve(-(J * v + bias));
    return inverse_mass * J.transpose() * r;
}

TEST_P(JointsOfEach, MoveMechanismsAsTheLinearEquationsSay) {
    Random random(3, "joints");
    for (int i = 0; i < 60; ++i) {
        const ContactProblem problem = mechanism(random, 1 + i % 12);
        const Answer a = answer(GetParam(), problem);
        EXPECT_FALSE(a.stats.missed) << i;
        const Eigen::VectorXd exact = exact_change(problem);
        EXPECT_LT((stacked(a.change) - exact).norm(), 1e-7 * (1 + exact.norm())) << i;
    }
}

TEST(Joints, ThatAreRedundantAreHarmless) {
    Random random(4, "joints");
    for (int i = 0; i < 40; ++i) {
        ContactProblem problem = mechanism(random, 4);
        const Eigen::VectorXd exact = exact_change(problem);
        const size_t count = problem.joints.size();
        for (size_t j = 0; j < count; ++j) problem.joints.push_back(problem.joints[j]);
        const Answer a = answer(Solver::newton, problem);
        EXPECT_FALSE(a.stats.missed) << i;
        EXPECT_LT((stacked(a.change) - exact).norm(), 1e-7 * (1 + exact.norm())) << i;
        // two redundant joints may share the load in any way, but must not push against each other
        for (size_t j = 0; j < count; ++j)
            EXPECT_LT(a.joints[j].norm() + a.joints[j + count].norm(),
                      2 * (a.joints[j] + a.joints[j + count]).norm() + 1e-5)
                << i;
    }
}

TEST_P(JointsOfEach, AreSpringsThatHoldAtTheEndOfTheStep) {
    // m (v+ - v) = r, and v+ + bias + compliance r = 0 with compliance = 1 / (h c + h^2 k) and bias
    // = h k x compliance, i.e. the implicit step of a spring and damper
    constexpr double kStep = 1e-3, kMass = 0.2, kX = 0.01, kSpeed = 0.3;
    for (const double k : {10.0, 1e3, 1e5, 1e8}) {
        for (const double c : {0.0, 1.0, 50.0}) {
            ContactProblem problem;
            problem.bodies.push_back(body(kMass, Vec3::Constant(1e-4)));
            problem.bodies[0].v_W = Vec3(kSpeed, 0.1, 0);
            problem.joints.push_back(along_x(0));
            const double compliance = 1 / (kStep * c + kStep * kStep * k);
            problem.joints[0].compliance[0] = compliance;
            problem.joints[0].bias[0] = kStep * k * kX * compliance;
            const Answer a = answer(GetParam(), problem);
            const double expected =
                (kMass * kSpeed - kStep * k * kX) / (kMass + kStep * c + kStep * kStep * k);
            EXPECT_NEAR(problem.bodies[0].v_W.x() + a.change[0][0], expected, 1e-10)
                << k << " " << c;
            EXPECT_NEAR(a.joints[0][0], kMass * (expected - kSpeed), 1e-10);
            EXPECT_EQ(a.change[0][1], 0);
        }
    }
}

TEST_P(JointsOfEach, StopAndRubWithinTheirBounds) {
    for (const double speed : {-0.4, -0.1, 0.1, 0.4}) {
        ContactProblem problem;
        problem.bodies.push_back(body(0.5, Vec3::Constant(1e-4)));
        problem.bodies[0].v_W.x() = speed;
        problem.joints.push_back(along_x(0));
        problem.joints[0].low[0] = 0;  // acts as a stop, which can only push
        EXPECT_NEAR(speed + answer(GetParam(), problem).change[0][0], std::max(0.0, speed), 1e-10);
        problem.joints[0].bias[0] = 0.2;  // the stop is 0.2 h away
        EXPECT_NEAR(speed + answer(GetParam(), problem).change[0][0], std::max(-0.2, speed), 1e-10);
        problem.joints[0].bias[0] = 0;
        problem.joints[0].low[0] = -0.1;  // dry friction: 0.1 N s slows it by 0.2 m/s
        problem.joints[0].high[0] = 0.1;
        const double left = std::abs(speed) > 0.2 ? speed - std::copysign(0.2, speed) : 0;
        EXPECT_NEAR(speed + answer(GetParam(), problem).change[0][0], left, 1e-10) << speed;
    }
}

TEST_P(JointsOfEach, AndContactsAreSolvedTogether) {
    // two cubes, joined by a rod, on a slope steeper than one cube's friction angle and less steep
    // than the other's: they slide as one mass with the mean of the two coefficients
    const double slope = 25 * kDegree;
    const Vec3 n(std::sin(slope), 0, std::cos(slope));
    ContactProblem problem = block_on_plane(n, 0.3);
    const ContactProblem other = block_on_plane(n, 0.5);
    problem.bodies.push_back(other.bodies[0]);
    for (ProblemContact contact : other.contacts) {
        contact.b = 1;
        problem.contacts.push_back(contact);
    }
    const Vec3 fall(std::cos(slope), 0, -std::sin(slope));
    ProblemJoint rod;
    rod.a = 0;
    rod.b = 1;
    rod.J_b.row(0).head<3>() = fall;
    rod.J_a = -rod.J_b;
    rod.low.tail<2>().setZero();
    rod.high.tail<2>().setZero();
    problem.joints.push_back(rod);
    const Answer a = answer(GetParam(), problem);
    EXPECT_FALSE(a.stats.missed);
    const double expected = 9.81e-3 * (std::sin(slope) - 0.4 * std::cos(slope));
    for (size_t i = 0; i < 2; ++i)
        EXPECT_LT((problem.bodies[i].v_W + a.change[i].head<3>() - expected * fall).norm(), 1e-8);
    // the rod pulls the cube that has more friction, with half of the difference
    EXPECT_NEAR(a.joints[0][0], 0.1 * 9.81e-3 * 0.1 * std::cos(slope), 1e-9);
}

TEST_P(JointsOfEach, OfJumblesWithContactsAreAnswered) {
    Random random(5, "joints");
    int missed = 0;
    for (int i = 0; i < 200; ++i) {
        ContactProblem problem = random_problem(random, 4, 8, i % 2 == 0 ? 0.005 : 0);
        for (int b = 1; b < 4; ++b)
            problem.joints.push_back(
                ball(b - 1, b, random_vector(random, 0.03), random_vector(random, 0.03)));
        problem.joints[1].low = Vec3::Constant(-1e-3);
        problem.joints[1].high = Vec3::Constant(1e-3);
        problem.joints[2].compliance = Vec3::Constant(0.1);
        missed += answer(GetParam(), problem).stats.missed;
    }
    EXPECT_LE(missed, 2);
}

TEST(Joints, AreHeldTogetherBySweepsToo) {
    Random random(6, "joints");
    const ContactProblem problem = mechanism(random, 3);
    ContactSolvers solvers;
    solvers.reserve(3, 0, false, static_cast<int>(problem.joints.size()));
    std::vector<Vec3> impulses(problem.joints.size(), Vec3::Zero());
    SolveStats stats;
    solvers.solve(Solver::sequential_impulse, {{}, {20000, 1e-12}, kUnbounded}, problem, {},
                  impulses, stats);
    const Eigen::VectorXd exact = exact_change(problem);
    for (int i = 0; i < 3; ++i)
        EXPECT_LT((solvers.velocity_change(i) - exact.segment<6>(6 * i)).norm(), 1e-6) << i;
}

TEST(Joints, AreSolvedWithoutAllocatingAndRefusedIfTheyAreNoNumbers) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Random random(7, "joints");
    ContactProblem problem = mechanism(random, 6);
    ContactSolvers solvers;
    solvers.reserve(6, 0, false, static_cast<int>(problem.joints.size()));
    std::vector<Vec3> impulses(problem.joints.size(), Vec3::Zero());
    SolveStats stats;
    const dihaptic::testing::AllocationGuard guard;
    solvers.solve(Solver::newton, {{}, {}, kUnbounded}, problem, {}, impulses, stats);
    EXPECT_EQ(guard.count(), 0u);
    EXPECT_FALSE(stats.refused);
    EXPECT_FALSE(stats.missed);
    problem.joints[2].compliance[1] = std::numeric_limits<double>::quiet_NaN();
    solvers.solve(Solver::newton, {{}, {}, kUnbounded}, problem, {}, impulses, stats);
    EXPECT_TRUE(stats.refused);
    EXPECT_EQ(impulses[0], Vec3::Zero());
}

}  // namespace
}  // namespace dihaptic::contact::joints_test
