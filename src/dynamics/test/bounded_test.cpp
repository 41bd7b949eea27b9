// Tests that every step for which a hand waits stays within the limit on counted work, and reports
// when this limit is reached.
#include <gtest/gtest.h>

#include "base/number.h"

#include "dynamics/test/extreme.h"

namespace dihaptic::dynamics::bounded_test {
namespace {

/// Additional work allowed per contact: assembly and the minimum number of sweeps, in each of five
/// passes.
constexpr int64_t kOnTop = 200;

TEST(Bounded, NoStepOfAnExtremeSceneDoesMoreThanItMay) {
    int touched = 0;
    int out_of_work = 0;
    for (uint64_t seed = 0; seed < 24; ++seed) {
        Extreme extreme(seed);
        for (int i = 0; i < 24; ++i) {
            // this is much more often than twenty times a second
            if (i % 6 == 0)
                extreme.world().set_solver(contact::Solver((i / 6 + seed) % contact::kSolvers));
            if (extreme.step(i) == StepStatus::diverged) extreme.world().mend();
            const contact::SolveStats& stats = extreme.world().solve_stats();
            const auto contacts = static_cast<int64_t>(extreme.world().contacts().size());
            EXPECT_LE(stats.work,
                      World::kMostSolveWork + World::kMostSearchWork + kOnTop * (contacts + 100))
                << seed << " " << i;
            if (stats.work >= World::kMostSolveWork + World::kMostSearchWork) {
                EXPECT_EQ(stats.route, contact::Route::out_of_work) << seed << " " << i;
            }
            EXPECT_GE(stats.ended, stats.route == contact::Route::out_of_work);
            out_of_work += stats.route == contact::Route::out_of_work ? 1 : 0;
            touched += extreme.touched() ? 1 : 0;
        }
    }
    EXPECT_GT(touched, 200);
    EXPECT_GT(out_of_work, 20);
}

TEST(Bounded, IsTheSameToTheBitWhenItIsRepeated) {
    const auto end = [] {
        Extreme extreme(7);
        for (int i = 0; i < 20; ++i) {
            if (i % 5 == 0) extreme.world().set_solver(contact::Solver(i / 5 % contact::kSolvers));
            extreme.step(i);
        }
        Vec3 sum = Vec3::Zero();
        for (const BodyState& state : extreme.world().states()) sum += state.X_WB.p + state.v_WB;
        return sum;
    };
    EXPECT_EQ(end(), end());
}

TEST(Bounded, APlateOnARailThatIsInsideTheTableIsSolvedAllTheSame) {
    for (int solver = 0; solver < contact::kSolvers; ++solver) {
        scene::Scene scene;
        scene.bodies = {table(), box("plate", {0.006, 0.04, 0.04}, {0, 0, 0}, 0.02)};
        scene.bodies[1].moves = scene::Axes::x;
        scene.bodies[1].turns = scene::Axes::none;
        frame::DynamicsSettings settings = awake();
        settings.solver = static_cast<contact::Solver>(solver);
        World world(scene, settings);
        scene::Finger finger;
        finger.shape = scene::Shape::box({0.005, 0.02, 0.02});
        finger.mass = 0.1;
        const BodyIndex index = world.add_proxy(finger, {-0.0056, 0, 0.025});
        world.activate();
        for (int i = 0; i < 100; ++i) {
            world.apply(index, {1, 0, 0}, Vec3::Zero());
            world.step(kStep);
            EXPECT_FALSE(world.solve_stats().missed) << solver << " " << i;
        }
        // 1 N has pushed 120 g for 0.1 s
        EXPECT_NEAR(world.state({1}).X_WB.p.x(), 0.5 * 1 / 0.12 * 0.01, 2e-3) << solver;
    }
}

/// A block held in the air between two pads. If `crushed`, a third pad presses on a block that is
/// crushed by two walls, which is a problem without a solution.
World two_hands(bool crushed) {
    scene::Scene scene;
    scene.bodies = {table(), box("crushed", Vec3::Constant(0.04), {0.5, 0, 0.02}, 0.1),
                    block({0, 0, 0.3})};
    if (crushed) {
        scene.bodies.push_back(box("left wall", {0.04, 1, 1}, {0.5 - 0.035, 0, 0}, 0));
        scene.bodies.push_back(box("right wall", {0.04, 1, 1}, {0.5 + 0.035, 0, 0}, 0));
    }
    World world(scene, awake());
    scene::Finger finger;
    finger.shape = scene::Shape::box({0.005, 0.02, 0.02});
    finger.mass = 1;
    for (const Vec3& place : {Vec3(-0.0225, 0, 0.3), Vec3(0.0225, 0, 0.3), Vec3(0.5, 0, 0.05)}) {
        finger.name = "finger " + number_text(world.size());
        world.add_proxy(finger, place);
    }
    world.activate();
    return world;
}
void squeeze(World& world) {
    const int first = world.scene_size();
    for (const int finger : {first, first + 1}) {
        const Vec3 v = world.state({finger}).v_WB;
        world.set_velocity({finger}, {v.x(), 0, 0});
        world.apply({finger}, {finger == first ? 5.0 : -5.0, 0, 0}, Vec3::Zero());
    }
    world.apply({first + 2}, {0, 0, -5}, Vec3::Zero());
    world.step(kStep);
}

TEST(Bounded, AHandWithoutAnAnswerLeavesTheOtherItsExactness) {
    World alone = two_hands(false);
    World beside = two_hands(true);
    int out_of_work = 0;
    for (int i = 0; i < 50; ++i) {
        squeeze(alone);
        squeeze(beside);
        out_of_work += beside.solve_stats().route == contact::Route::out_of_work ? 1 : 0;
        EXPECT_FALSE(alone.solve_stats().ended);
    }
    EXPECT_GT(out_of_work, 25);
    EXPECT_LT((alone.state({2}).X_WB.p - beside.state({2}).X_WB.p).norm(), 1e-9);
}

}  // namespace
}  // namespace dihaptic::dynamics::bounded_test
