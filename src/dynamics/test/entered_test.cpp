// Tests that fast bodies do not enter each other, even if this cannot be foreseen from the contacts
// at the start of the step.
#include <gtest/gtest.h>

#include <numbers>

#include "base/random.h"
#include "dynamics/test/blocks.h"
#include "testing/overlap.h"

namespace dihaptic::dynamics::entered_test {
namespace {

constexpr double kDeep = 2e-4;  // twice the depth that a step tolerates [m]

class EnteredTest : public ::testing::TestWithParam<contact::Solver> {
  protected:
    World weightless(std::vector<scene::Body> bodies, const scene::Finger* finger = nullptr,
                     const Vec3& p_WP = Vec3::Zero()) {
        scene::Scene scene;
        scene.gravity.setZero();
        scene.bodies = std::move(bodies);
        frame::DynamicsSettings settings;
        settings.solver = GetParam();
        World world(scene, settings);
        if (finger != nullptr) world.add_proxy(*finger, p_WP);
        world.activate();
        return world;
    }
    static scene::Body slippery(scene::Body body) {
        body.friction = 0;
        return body;
    }
};
INSTANTIATE_TEST_SUITE_P(Solvers, EnteredTest,
                         ::testing::Values(contact::Solver::sequential_impulse,
                                           contact::Solver::stewart_trinkle,
                                           contact::Solver::staggered_projections,
                                           contact::Solver::newton),
                         [](const auto& test) { return std::string(enum_name(test.param)); });

TEST_P(EnteredTest, ABoxThatSpinsPastABlockStaysOutsideOfItAndGainsNoEnergy) {
    // the box spins by 0.4 rad per step, so that one of its corners swings into the face next to it
    const Vec3 half = Vec3::Constant(0.02);
    for (uint64_t i = 0; i < 20; ++i) {
        Random random(i, "spin");
        const auto any = [&] {
            return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        };
        scene::Body spinner = slippery(block({0, 0, 0}));
        spinner.rotation = 3 * any();
        const Quat R = rotation_xyz(spinner.rotation);
        const Vec3 way = any().normalized();
        double far = 0.1;
        while (box_overlap(half, {}, half, {R, far * way}) < -1e-3) far -= 1e-4;
        spinner.position = far * way;
        World world = weightless({slippery(box("fixed", 2 * half, Vec3::Zero(), 0)), spinner});
        const Vec3 v = -2 * way + any();
        world.set_velocity({1}, v);
        const double inertia = 0.1 * 0.04 * 0.04 / 6;
        world.apply({1}, Vec3::Zero(), 400 * inertia / kStep * any().normalized());
        double before = 0.1 / 2 * v.squaredNorm() + inertia / 2 * 400 * 400;
        for (int step = 0; step < 10; ++step) {
            world.step(kStep);
            const BodyState& s = world.states()[1];
            ASSERT_LT(box_overlap(half, {}, half, s.X_WB), 2 * kDeep) << i << ", " << step;
            const double energy =
                0.1 / 2 * s.v_WB.squaredNorm() + inertia / 2 * s.w_WB.squaredNorm();
            ASSERT_LT(energy, before * (1 + 1e-4)) << i << ", " << step;
            before = energy;
        }
    }
}

TEST_P(EnteredTest, ABodyStoppedInFrontOfAnotherIsNotEntered) {
    // both blocks have the same velocity, so their contact is not foreseen; the wall stops the
    // first block, which stops the second one
    World world = weightless({slippery(box("wall", {0.1, 1, 1}, {0.05, 0, 0}, 0)),
                              slippery(block({-0.0210, 0, 0})), slippery(block({-0.0625, 0, 0}))});
    for (int i : {1, 2}) world.set_velocity({i}, {5, 0, 0});
    for (int step = 0; step < 5; ++step) {
        world.step(kStep);
        const double first = world.states()[1].X_WB.p.x();
        EXPECT_LT(first, -0.02 + kDeep);
        EXPECT_LT(world.states()[2].X_WB.p.x(), first - 0.04 + kDeep);
    }
    EXPECT_NEAR(world.states()[2].v_WB.x(), 0, 1e-3);
}

TEST_P(EnteredTest, ABallStoppedInFrontOfAnotherIsNotEntered) {
    // like the blocks above, from beyond the search distance for round shapes
    const auto ball = [](double x) {
        scene::Body body = slippery(block({x, 0, 0}));
        body.shape.kind = scene::ShapeKind::sphere;
        body.shape.radius = 0.02;
        return body;
    };
    World world = weightless(
        {slippery(box("wall", {0.1, 1, 1}, {0.05, 0, 0}, 0)), ball(-0.0210), ball(-0.0645)});
    for (int i : {1, 2}) world.set_velocity({i}, {5, 0, 0});
    for (int step = 0; step < 5; ++step) {
        world.step(kStep);
        const double first = world.states()[1].X_WB.p.x();
        EXPECT_LT(first, -0.02 + kDeep);
        EXPECT_LT(world.states()[2].X_WB.p.x(), first - 0.04 + kDeep);
    }
    EXPECT_NEAR(world.states()[2].v_WB.x(), 0, 1e-3);
}

TEST_P(EnteredTest, ACapsuleThatSlapsDownOnOneEndMeetsWithTheOtherInTime) {
    scene::Body capsule = slippery(block({0, 0, 0.0305}));
    capsule.shape.kind = scene::ShapeKind::capsule;
    capsule.shape.radius = 0.01;
    capsule.shape.length = 0.1;
    capsule.rotation.y() = std::numbers::pi / 2 - 0.4;  // rests on one end while the other falls
    capsule.position.z() = 0.01 + 0.05 * std::sin(0.4) + 1e-4;
    World world = weightless({slippery(table()), capsule});
    world.set_velocity({1}, {0, 0, -4});
    double lowest = 1;
    double fastest = 0;
    for (int step = 0; step < 60; ++step) {
        world.step(kStep);
        const BodyState& s = world.states()[1];
        fastest = std::max(fastest, s.w_WB.norm());
        const double tilt = std::abs((s.X_WB.R * Vec3::UnitZ()).z());
        lowest = std::min(lowest, s.X_WB.p.z() - 0.05 * tilt - 0.01);
    }
    EXPECT_GT(fastest, 20);
    EXPECT_GT(lowest, -kDeep);
}

TEST_P(EnteredTest, AFingerThatComesFreeGoesThroughNothing) {
    // 70 mm in a step, at an angle, so that at first no face of the block is opposite the finger
    scene::Finger finger;
    finger.name = "finger";
    finger.shape = scene::Shape::box(Vec3::Constant(0.01));
    finger.friction = 0;
    World world = weightless({slippery(block({0, 0, 0}))}, &finger, {0.045, 0.035, 0.004});
    const Vec3 v(-57, -41, 0);
    world.set_velocity({1}, v);
    const double mass = world.mass({1});
    for (int step = 0; step < 3; ++step) {
        world.step(kStep);
        const Vec3 apart = world.states()[1].X_WB.p - world.states()[0].X_WB.p;
        // the block may turn when it is hit off-centre
        const Mat3 R = world.states()[0].X_WB.R.toRotationMatrix();
        const Vec3 by_block = (R.transpose() * apart).cwiseAbs() - Vec3::Constant(0.02) -
                              0.005 * R.transpose().cwiseAbs() * Vec3::Ones();
        const Vec3 by_finger =
            apart.cwiseAbs() - Vec3::Constant(0.005) - 0.02 * R.cwiseAbs() * Vec3::Ones();
        EXPECT_GT(std::max(by_block.maxCoeff(), by_finger.maxCoeff()), -kDeep) << step;
    }
    EXPECT_GT(world.states()[0].v_WB.norm(), 0.1);
    const Vec3 momentum = mass * world.states()[1].v_WB + 0.1 * world.states()[0].v_WB;
    EXPECT_LT((momentum - mass * v).norm(), 1e-9 * mass * v.norm());
}

}  // namespace
}  // namespace dihaptic::dynamics::entered_test
