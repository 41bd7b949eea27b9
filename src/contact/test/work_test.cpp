// Tests that the total work of all solves in a tick is bounded, whichever solver is requested.
#include <gtest/gtest.h>

#include "contact/test/problems.h"

namespace dihaptic::contact::work_test {
namespace {

TEST(WorkTest, KeepsAShareForSweepsAndForOthers) {
    Work work(1000);
    work.begin_exact();
    EXPECT_TRUE(work.affords(800));
    EXPECT_FALSE(work.affords(801));
    work.spend(800);
    EXPECT_FALSE(work.affords(1));
    EXPECT_EQ(work.times(10), 0);
    work.begin_sweeps(0);
    EXPECT_EQ(work.times(10), 20);
    work.spend(150);
    work.begin_sweeps(120);  // these sweeps are always allowed
    EXPECT_TRUE(work.affords(120));
    EXPECT_FALSE(work.affords(121));

    Work shared(1000);
    shared.share(2);
    shared.begin_sweeps(0);
    EXPECT_EQ(shared.times(1), 500);
    shared.spend(100);
    shared.share(1);
    shared.begin_sweeps(0);
    EXPECT_EQ(shared.times(1), 900);
}

class EachSolversWork : public ::testing::TestWithParam<Solver> {};
INSTANTIATE_TEST_SUITE_P(Contact, EachSolversWork,
                         ::testing::Values(Solver::sequential_impulse, Solver::stewart_trinkle,
                                           Solver::staggered_projections, Solver::newton),
                         [](const auto& which) {
                             return std::string(
                                 enum_names(Solver{})[static_cast<size_t>(which.param)]);
                         });

/// A problem with two contradictory loads: there is no answer, and unless the work is bounded, each
/// solver tries all the others.
ContactProblem without_answer(Random& random, int bodies, int contacts) {
    ContactProblem out = testing::random_problem(random, bodies, contacts);
    for (size_t j = 0; j < 2; ++j) {
        out.contacts[j] = out.contacts[0];
        out.contacts[j].a = kFixed;
        out.contacts[j].bias = -1;
        if (j == 1) out.contacts[j].R_WC = testing::frame_of(-out.contacts[0].R_WC.col(0));
    }
    return out;
}

TEST_P(EachSolversWork, IsBoundedWhereThereIsNoAnswer) {
    Random random(21, "without an answer");
    ContactSolvers solvers;
    solvers.reserve(6, 24, false);
    int out_of_work = 0;
    for (int i = 0; i < 12; ++i) {
        const ContactProblem problem = without_answer(random, 6, 24);
        const int64_t most = 2000 << (i % 6);
        Work tick(most);
        SolveSettings settings;
        settings.tick = &tick;
        settings.sweeps.tolerance = 0;
        std::vector<Impulse> r(24, Impulse::Zero());
        SolveStats stats;
        solvers.solve(GetParam(), settings, problem, r, stats);
        EXPECT_EQ(stats.work, tick.spent());
        // additional work: assembly, the minimum number of sweeps, and their final residual
        EXPECT_LE(stats.work, most + 24 * 40) << i;
        EXPECT_TRUE(stats.missed);
        EXPECT_EQ(stats.ended, stats.route == Route::out_of_work);
        out_of_work += stats.ended ? 1 : 0;
        for (const Impulse& impulse : r) EXPECT_TRUE(impulse.allFinite());
    }
    EXPECT_GE(out_of_work, 6);
}

TEST_P(EachSolversWork, IsSharedByTheSolvesOfATick) {
    Random random(22, "random problems");
    ContactSolvers solvers;
    solvers.reserve(6, 24, false);
    Work tick(40'000);
    SolveSettings settings;
    settings.tick = &tick;
    settings.sweeps.tolerance = 0;
    SolveStats stats;
    int solves = 0;
    for (; solves < 1000 && !stats.ended; ++solves) {
        const ContactProblem problem = testing::random_problem(random, 6, 24);
        std::vector<Impulse> r(24, Impulse::Zero());
        solvers.solve(GetParam(), settings, problem, r, stats);
    }
    EXPECT_GT(solves, 1);
    EXPECT_LT(solves, 1000);
    EXPECT_EQ(stats.route, Route::out_of_work);
    EXPECT_LE(tick.spent(), 40'000 + 24 * 40);
}

TEST_P(EachSolversWork, ChangesNothingWhereThereIsEnoughOfIt) {
    Random random(23, "random problems");
    ContactSolvers solvers;
    solvers.reserve(6, 24, true);
    for (int i = 0; i < 30; ++i) {
        const ContactProblem problem =
            testing::random_problem(random, 1 + i % 6, 1 + i % 24, i % 2 == 0 ? 0 : 0.005);
        std::vector<Impulse> alone(problem.contacts.size(), Impulse::Zero());
        std::vector<Impulse> in_tick = alone;
        SolveStats stats;
        solvers.solve(GetParam(), {}, problem, alone, stats);
        Work tick(20'000'000);  // half of which is left to newton
        SolveSettings settings;
        settings.tick = &tick;
        SolveStats again;
        solvers.solve(GetParam(), settings, problem, in_tick, again);
        EXPECT_EQ(alone, in_tick) << i;
        EXPECT_EQ(stats.route, again.route);
        EXPECT_EQ(stats.work, again.work);
        EXPECT_FALSE(again.ended);
    }
}

TEST_P(EachSolversWork, LeavesHalfToNewton) {
    Random random(23, "random problems");
    ContactSolvers solvers;
    solvers.reserve(6, 24, true);
    int without = 0;
    for (int i = 0; i < 300; ++i) {
        const ContactProblem problem = testing::random_problem(random, 1 + i % 6, 12 + i % 13);
        std::vector<Impulse> r(problem.contacts.size(), Impulse::Zero());
        Work tick(400'000);  // World::kMostSolveWork
        SolveSettings settings;
        settings.tick = &tick;
        SolveStats stats;
        solvers.solve(GetParam(), settings, problem, r, stats);
        without += stats.route == Route::out_of_work;
    }
    EXPECT_LE(without, 2);  // stewart_trinkle left none in 49 of these problems before it shared
}

TEST_P(EachSolversWork, IsNotSpentOnWhatNothingCanPushApart) {
    // on a rail along x, deep inside a table, so that the contact requires an impossible motion
    ContactProblem problem = testing::block_on_plane(Vec3::UnitZ(), 0.8);
    for (const int i : {1, 2, 3, 4, 5}) hold(problem.bodies[0].inverse_mass, i);
    problem.bodies[0].v_W = {0.1, 0, 0};
    for (ProblemContact& contact : problem.contacts) contact.bias = -5;
    const testing::Answer a = testing::answer(GetParam(), problem);
    EXPECT_FALSE(a.stats.missed);
    EXPECT_LT(a.stats.work, 5000);
    EXPECT_NEAR(a.change[0].norm(), 0, 1e-12);
}

}  // namespace
}  // namespace dihaptic::contact::work_test
