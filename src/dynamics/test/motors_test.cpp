// Tests joint motors against closed forms: their push, how they reach their target, and their force
// on obstacles.
#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/test/blocks.h"
#include "testing/allocation_guard.h"

namespace dihaptic::dynamics::motors_test {
namespace {

constexpr double kMass = 0.1, kSide = 0.04;
constexpr double kInertia = kMass * kSide * kSide / 6;

/// A rail on which a block slides along x in mid-air.
scene::Joint rail() {
    return joint(scene::JointKind::slider, {"block"}, {0, 0, 0.2}, Vec3::UnitX());
}

World make(std::vector<scene::Body> bodies, const scene::Joint& joint,
           const Vec3& gravity = {0, 0, -kGravity}) {
    scene::Scene scene;
    scene.bodies = std::move(bodies);
    scene.joints = {joint};
    scene.gravity = gravity;
    World world(scene, awake());
    world.activate();
    return world;
}

TEST(Motor, PushesBothBodiesOfASliderOppositely) {
    scene::Body other = box("other", Vec3::Constant(kSide), {0.1, 0, 0}, 0.3);
    World world = make({block({0, 0, 0}), other},
                       joint(scene::JointKind::slider, {"block", "other"}, Vec3::Zero(), {2, 0, 0}),
                       Vec3::Zero());
    constexpr double kPush = 0.4;
    for (int i = 0; i < 100; ++i) {
        world.drive_joint(0, {{}, 0, kPush});
        world.step(kStep);
    }
    EXPECT_NEAR(world.states()[0].v_WB.x(), -kPush / kMass * 0.1, 1e-9);
    EXPECT_NEAR(world.states()[1].v_WB.x(), kPush / 0.3 * 0.1, 1e-9);
    // a motor stops unless it is driven again
    const double before = world.joints()[0].velocity;
    world.step(kStep);
    EXPECT_NEAR(world.joints()[0].velocity, before, 1e-12);
}

TEST(Motor, GivesWhatBouncesOffItsBodyTwiceItsSpeed) {
    for (const double restitution : {0.5, 1.0}) {
        scene::Body ball;
        ball.name = "ball";
        ball.shape = scene::Shape::sphere(0.02);
        ball.mass = 0.02;
        ball.position = {0.1, 0, 0.2};
        ball.surface.restitution = restitution;
        World world = make({block({0, 0, 0.2}), ball}, rail(), Vec3::Zero());
        constexpr double kSpeed = 0.5;
        for (int i = 1; i <= 250; ++i) {
            world.drive_joint(0, {kSpeed * kStep * i, 1e4, 0});
            world.step(kStep);
        }
        EXPECT_NEAR(world.states()[1].v_WB.x(), (1 + restitution) * kSpeed, 0.01 * kSpeed);
    }
}

TEST(Motor, TurnsAHingeByItsTorque) {
    World world = make({block({0, 0, 0})},
                       joint(scene::JointKind::hinge, {"block"}, Vec3::Zero(), Vec3::UnitZ()));
    constexpr double kTorque = 1e-4;
    for (int i = 0; i < 100; ++i) {
        world.drive_joint(0, {{}, 0, kTorque});
        world.step(kStep);
    }
    EXPECT_NEAR(world.states()[0].w_WB.z(), kTorque / kInertia * 0.1, 1e-9);
}

TEST(Motor, FollowsAPathAgainstFrictionAndLoads) {
    scene::Joint slider = rail();
    slider.friction = 0.5;
    World world = make({block({0, 0, 0.2})}, slider);
    for (int i = 1; i < 2000; ++i) {
        const double t = i * kStep;
        const double to = 0.03 * (1 - std::cos(10 * t));
        world.drive_joint(0, {to, 20, 0});
        world.apply({0}, {2, 0, 0}, Vec3::Zero());
        world.step(kStep);
        ASSERT_NEAR(world.joints()[0].position, to, 1e-7) << t;
        // the motor's force is the force that the path requires, minus the push
        if (i > 2) {
            const double acceleration = 0.03 * 100 * std::cos(10 * (t - kStep));
            ASSERT_NEAR(world.joints()[0].force_W.x(), kMass * acceleration - 2, 0.01) << t;
        }
    }
}

TEST(Motor, PressesNoHarderThanItCan) {
    World world = make({block({0, 0, 0.2}), box("wall", {0.02, 1, 1}, {0.05, 0, 0.2}, 0)}, rail());
    constexpr double kMost = 3;
    for (int i = 0; i < 1000; ++i) {
        world.drive_joint(0, {0.1, kMost, 0});
        world.step(kStep);
    }
    double pressed = 0;
    for (const contact::Contact& contact : world.contacts()) pressed += contact.normal_force;
    EXPECT_NEAR(pressed, kMost, 1e-9);
    EXPECT_NEAR(world.joints()[0].position, 0.02, 1e-6);
}

/// Returns by how much the block overshoots on a path of 10 cm, and its final position.
std::pair<double, double> arrives(double most, double load, bool tells_early) {
    World world = make({block({0, 0, 0.2})}, rail());
    double beyond = 0;
    for (int i = 0; i < 4000; ++i) {
        const double to = tells_early ? 0.1 : std::min(0.1, 0.1 * i * kStep);
        world.drive_joint(0, {to, most, 0});
        world.apply({0}, {load, 0, 0}, Vec3::Zero());
        world.step(kStep);
        beyond = std::max(beyond, world.joints()[0].position - to);
    }
    return {beyond, world.joints()[0].position};
}

TEST(Motor, ThatIsFarFromItsEndStopsThere) {
    for (const double most : {0.01, 0.1, 1.0, 10.0, 1000.0}) {
        for (const bool tells_early : {true, false}) {
            const auto [beyond, end] = arrives(most, 0, tells_early);
            // stopping from 0.1 m/s at an unforeseen end takes a distance of v^2 / (2 a)
            const double foreseen = tells_early ? 0 : 0.01 / (2 * most / kMass);
            EXPECT_LT(beyond, foreseen + 1e-3) << most << " " << tells_early;
            EXPECT_NEAR(end, 0.1, most < 0.1 ? 5e-3 : 1e-6) << most << " " << tells_early;
        }
    }
}

TEST(Motor, StopsInTimeWhereALoadTakesLessThanHalfOfItsForce) {
    for (const double share : {-0.45, 0.45}) {
        const auto [beyond, end] = arrives(1, share, true);
        EXPECT_LT(beyond, 1e-3) << share;
        EXPECT_NEAR(end, 0.1, 1e-6) << share;
    }
}

TEST(JointProperties, ChangeSpringDamperAndFriction) {
    scene::Joint slider = rail();
    slider.axis = Vec3::UnitZ();
    slider.stiffness = 100;
    slider.damping = 5;
    World world = make({block({0, 0, 0.2})}, slider);
    const auto settled = [&](const JointProperties& properties) {
        world.set_joint_properties(0, properties);
        for (int i = 0; i < 4000; ++i) world.step(kStep);
        return world.joints()[0].position;
    };
    const double sag = kMass * kGravity / slider.stiffness;
    EXPECT_NEAR(settled({}), -sag, 1e-6);
    EXPECT_NEAR(settled({.stiffness = 0.5}), -2 * sag, 1e-6);
    EXPECT_NEAR(settled({.stiffness = 2}), -sag / 2, 1e-6);
    // without a spring, the block falls at the speed at which the damper supports its weight
    world.set_joint_properties(0, {.stiffness = 0, .damping = 3});
    for (int i = 0; i < 1000; ++i) world.step(kStep);
    EXPECT_NEAR(world.joints()[0].velocity, -kMass * kGravity / 15, 1e-6);
}

TEST(JointProperties, ChangeDryFriction) {
    scene::Joint slider = rail();
    slider.friction = 1;
    World world = make({block({0, 0, 0.2})}, slider);
    const auto speed_after_pull = [&](double friction) {
        world.set_joint_properties(0, {.friction = friction});
        world.set_velocity({0}, Vec3::Zero());
        for (int i = 0; i < 100; ++i) {
            world.apply({0}, {0.9, 0, 0}, Vec3::Zero());
            world.step(kStep);
        }
        return world.joints()[0].velocity;
    };
    EXPECT_EQ(speed_after_pull(1), 0);
    EXPECT_NEAR(speed_after_pull(0.5), 0.4 / kMass * 0.1, 1e-9);
}

TEST(Motor, AllocatesNothing) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    World world = make({block({0, 0, 0.2})}, rail());
    const testing::AllocationGuard guard;
    for (int i = 0; i < 100; ++i) {
        world.set_joint_properties(0, {.friction = i % 3 + 1.0});
        world.drive_joint(0, {0.01, 5, 1});
        world.step(kStep);
    }
    EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace dihaptic::dynamics::motors_test
