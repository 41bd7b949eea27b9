// Tests the figures of `dihaptic-bench solvers`, except times, with few solves.
#include <gtest/gtest.h>

#include "bench/bullet_problem.h"
#include "bench/solver_problems.h"
#include "bench/solvers.h"

namespace dihaptic::bench::solvers_bench_test {
namespace {

TEST(BulletProblem, IsTheSameProblem) {
    // a block at rest on four corners, solved by any number of iterations
    contact::ContactProblem problem;
    contact::ProblemBody block;
    block.inverse_mass.diagonal() << Vec3::Constant(1 / 0.1),
        Vec3::Constant(1 / (0.1 * 0.04 * 0.04 / 6));
    block.v_W = {0, 0, -9.81e-3};
    problem.bodies = {block};
    for (const double x : {-0.02, 0.02}) {
        for (const double y : {-0.02, 0.02}) {
            contact::ProblemContact contact;
            contact.b = 0;
            contact.p_BC_W = {x, y, -0.02};
            contact.R_WC.col(0) = Vec3::UnitZ();
            contact.R_WC.col(1) = Vec3::UnitX();
            contact.R_WC.col(2) = Vec3::UnitY();
            contact.friction = 0.5;
            problem.contacts.push_back(contact);
        }
    }
    const std::vector<contact::Impulse> start(4, contact::Impulse::Zero());
    BulletProblem bullet(problem, start);
    btSequentialImpulseConstraintSolver solver;
    for (int again = 0; again < 2; ++again) {
        bullet.reset();
        bullet.solve(solver, 500);
        const std::vector<contact::Impulse> r = bullet.impulses();
        EXPECT_LT(contact::natural_map_residual(problem, r), 1e-9);
        double sum = 0;
        for (const contact::Impulse& impulse : r) sum += impulse[0];
        EXPECT_NEAR(sum, 0.1 * 9.81e-3, 1e-9);
    }
    // a gap that remains open in the step has no impulse
    for (contact::ProblemContact& contact : problem.contacts) contact.bias = 0.02;
    BulletProblem apart(problem, start);
    apart.solve(solver, kBulletIterations);
    for (const contact::Impulse& impulse : apart.impulses()) EXPECT_EQ(impulse.norm(), 0);
}

}  // namespace
}  // namespace dihaptic::bench::solvers_bench_test
