// Tests that bodies which do not touch are solved separately: a held body is solved exactly,
// independently of the rest of the world.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/number.h"

#include "dynamics/test/blocks.h"

namespace dihaptic::dynamics::islands_test {
namespace {

/// A world with a block held in the air between two pads and, away from it, a wall of loose bricks.
World held_block(int columns, contact::Solver solver = contact::Solver::newton) {
    scene::Scene scene;
    scene.bodies = {table(), block({0, 0, 0.3})};
    for (int i = 0; i < 10 * columns; ++i) {
        const int row = i / columns;
        const double x = 0.3 + 0.042 * (i % columns) + 0.02 * (row % 2);
        scene.bodies.push_back(box("loose " + number_text(i), Vec3::Constant(0.04),
                                   {x, 0, 0.021 + 0.0405 * row}, 0.05));
    }
    frame::DynamicsSettings settings = awake();
    settings.solver = solver;
    World world(scene, settings);
    for (const double side : {-1.0, 1.0}) {
        scene::Finger finger;
        finger.name = side < 0 ? "left" : "right";
        finger.shape = scene::Shape::box({0.005, 0.02, 0.02});
        finger.mass = 1;
        world.add_proxy(finger, {side * 0.0225, 0, 0.3});
    }
    world.activate();
    return world;
}
void step(World& world, int tick) {
    const int left = world.scene_size();
    for (const int finger : {left, left + 1}) {
        const Vec3 v = world.state({finger}).v_WB;
        world.set_velocity({finger}, {v.x(), 0, 0});
        world.apply({finger}, {finger == left ? 5.0 : -5.0, 0, 0}, Vec3::Zero());
    }
    for (int i = 2; i < left; ++i)
        world.apply({i}, {0.1 * std::sin(0.2 * tick + i), 0, 0}, Vec3::Zero());
    world.step(kStep);
}

TEST(Islands, AHeapDoesNotCostTheHandItsExactness) {
    World alone = held_block(0);
    World beside = held_block(3);
    int ended = 0;
    for (int i = 0; i < 200; ++i) {
        step(alone, i);
        step(beside, i);
        EXPECT_FALSE(alone.solve_stats().missed);
        EXPECT_LE(beside.held_residual(), 1e-8) << i;
        EXPECT_GE(beside.solve_stats().residual, beside.held_residual());
        ended += beside.solve_stats().ended ? 1 : 0;
    }
    EXPECT_GT(ended, 100);  // of a wall with some 200 contacts
    EXPECT_LT((alone.state({1}).X_WB.p - beside.state({1}).X_WB.p).norm(), 1e-9);
    EXPECT_NEAR(beside.state({1}).X_WB.p.z(), 0.3, 1e-3);
}

/// A world with a finger, and away from it a pit full of boxes and balls.
World pit(int loose) {
    scene::Scene scene;
    scene.bodies = {table()};
    for (int side = 0; side < 4; ++side) {
        const bool along_x = side < 2;
        const double at = side % 2 == 0 ? -0.1 : 0.1;
        scene.bodies.push_back(box("wall " + number_text(side),
                                   along_x ? Vec3(0.05, 0.25, 0.6) : Vec3(0.25, 0.05, 0.6),
                                   along_x ? Vec3(at, 0, 0.3) : Vec3(0, at, 0.3), 0));
    }
    for (int i = 0; i < loose; ++i) {
        scene::Body body =
            box("loose " + number_text(i), {0.03, 0.035, 0.04},
                {0.047 * (i % 3 - 1), 0.047 * (i / 3 % 3 - 1), 0.04 + 0.066 * (i / 9)}, 0.05);
        if (i % 2 == 1) body.shape = scene::Shape::sphere(0.018);
        body.rotation = {0.3 * i, 0.2 * i, 0.1 * i};
        scene.bodies.push_back(body);
    }
    World world(scene, awake());
    scene::Finger finger;
    finger.name = "finger";
    finger.shape = scene::Shape::sphere(0.01);
    finger.mass = 0.02;
    world.add_proxy(finger, {1, 0, 0.5});
    world.activate();
    return world;
}
/// What a pit was like while its bodies were stirred.
struct Stirred {
    double deepest = 0;        // [m]
    int ended = 0;             // number of steps
    int began_unbalanced = 0;  // number of steps whose books do not balance, while the bodies fall
    int unbalanced = 0;        // the same for later steps
    Vec3 sum = Vec3::Zero();   // of all positions and velocities, at the end
};
Stirred stir(int loose, int ticks) {
    World world = pit(loose);
    Stirred out;
    for (int tick = 0; tick < ticks; ++tick) {
        for (int i = 5; i < 5 + loose; ++i)
            world.apply({i}, {0.2 * std::sin(0.1 * tick + i), 0.2 * std::cos(0.13 * tick + i), 0},
                        Vec3::Zero());
        world.step(kStep);
        out.ended += world.solve_stats().ended ? 1 : 0;
        const bool falls = tick < ticks / 2;
        (falls ? out.began_unbalanced : out.unbalanced) += world.balance().unbalanced ? 1 : 0;
        if (falls) continue;
        for (const contact::Contact& contact : world.contacts())
            out.deepest = std::max(out.deepest, -contact.gap);
    }
    for (const BodyState& state : world.states()) out.sum += state.X_WB.p + state.v_WB;
    return out;
}

TEST(Islands, BodiesOfAHeapStayOutOfEachOtherThoughContactsAreCarriedAlong) {
    const Stirred heap = stir(45, 1200);
    EXPECT_GT(heap.ended, 400);
    EXPECT_GT(heap.deepest, 0);
    EXPECT_LT(heap.deepest, 2e-4);
    EXPECT_EQ(stir(45, 1200).sum, heap.sum);
}

TEST(Islands, AJammedHeapBalances) {
    const Stirred heap = stir(45, 1600);
    EXPECT_GT(heap.ended, 1000);
    EXPECT_EQ(heap.unbalanced, 0);
    // some bodies begin inside the walls, so that energy comes from nowhere
    EXPECT_GT(heap.began_unbalanced, 50);
    EXPECT_LT(heap.deepest, 2e-4);
}

TEST(Islands, WorkIsBoundedOnlyWhereAHandWaits) {
    std::vector<scene::Body> bodies{table()};
    for (int i = 0; i < 20; ++i)
        bodies.push_back(
            box("block " + number_text(i), Vec3::Constant(0.04), {0, 0, 0.02 + 0.04 * i}, 0.1));
    World world = make(bodies, awake());
    for (int i = 0; i < 20; ++i) {
        world.step(kStep);
        EXPECT_FALSE(world.solve_stats().ended);
        EXPECT_LE(world.solve_stats().residual, 1e-8);
        EXPECT_EQ(world.held_residual(), 0);
    }
}

TEST(Islands, AreSolvedApartWithWorkAndIterationsSummed) {
    const auto iterations = [](int blocks) {
        std::vector<scene::Body> bodies{table()};
        for (int i = 0; i < blocks; ++i)
            bodies.push_back(
                box("block " + number_text(i), Vec3::Constant(0.04), {0.1 * i, 0, 0.02}, 0.1));
        World world = make(bodies, awake());
        int problems = 0;
        world.watch_problems([&](const auto& problem, auto) {
            ++problems;
            EXPECT_EQ(problem.bodies.size(), 1u);
        });
        world.step(kStep);
        EXPECT_EQ(problems, blocks);
        EXPECT_GT(world.solve_stats().work, 0);
        return world.solve_stats().iterations;
    };
    EXPECT_EQ(iterations(3), 3 * iterations(1));
}

TEST(Carried, ImpulsesOutliveManyMoreContactsThanAreReserved) {
    // a rocking block keeps making new contact points: records of old points are reused
    frame::DynamicsSettings settings = awake();
    settings.max_contacts = 16;
    World world = make({table(), block({0, 0, 0.02})}, settings);
    for (int i = 0; i < 3000; ++i) {
        world.apply({1}, {0, 0, 0}, {0.03 * std::sin(0.05 * i), 0.03 * std::cos(0.031 * i), 0});
        ASSERT_EQ(world.step(kStep), StepStatus::ok);
        double force = 0;
        for (const contact::Contact& c : world.contacts()) force += c.normal_force;
        EXPECT_GE(force, 0);
    }
    EXPECT_LT(world.state({1}).X_WB.p.z(), 0.05);
}

}  // namespace
}  // namespace dihaptic::dynamics::islands_test
