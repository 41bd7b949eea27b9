// Tests driven bodies: platforms that rise, shake and turn with bodies on them, and bodies that are
// released while in motion.
#include <gtest/gtest.h>

#include <cmath>

#include "base/unit.h"
#include "dynamics/test/blocks.h"
#include "testing/allocation_guard.h"

namespace dihaptic::dynamics::drive_test {
namespace {

constexpr BodyIndex kPlatform{0}, kBlock{1};

scene::Body platform() {
    scene::Body out = box("platform", {0.3, 0.3, 0.04}, {0, 0, -0.02}, 0, 0.5);
    out.fixed = false;
    out.driven = true;
    return out;
}

World with_block() {
    return make({platform(), block({0, 0, 0.02}, 0.5)}, awake());
}

/// Position at time t of a platform that oscillates along one axis.
Vec3 swing(const Vec3& amplitude, double omega, double t) {
    return Vec3(0, 0, -0.02) + amplitude * (1 - std::cos(omega * t)) / 2;
}

double load_on(const World& world) {
    double sum = 0;
    for (const contact::Contact& c : world.contacts()) sum += c.normal_force;
    return sum;
}

TEST(Driven, StaysWhereNothingDrivesIt) {
    World world = with_block();
    for (int i = 0; i < 1000; ++i) {
        world.apply(kPlatform, {5, 0, -50}, {1, 0, 0});
        world.step(kStep);
    }
    EXPECT_EQ(world.state(kPlatform).X_WB.p, Vec3(0, 0, -0.02));
    EXPECT_NEAR(world.state(kBlock).X_WB.p.z(), 0.02, 1e-6);
}

TEST(Driven, LiftsWhatStandsOnItWithItsWeightAndInertia) {
    World world = with_block();
    constexpr double kAmplitude = 0.05, kOmega = 8;
    double before = 0;
    for (int i = 1; i < 2000; ++i) {
        const double t = i * kStep;
        const Vec3 to = swing({0, 0, kAmplitude}, kOmega, t);
        world.drive(kPlatform, {Quat::Identity(), to});
        world.step(kStep);
        EXPECT_LT((world.state(kPlatform).X_WB.p - to).norm(), 1e-12);
        EXPECT_NEAR(world.state(kBlock).X_WB.p.z() - to.z(), 0.04, 2e-6) << t;
        const double v = world.state(kPlatform).v_WB.z();
        EXPECT_NEAR(load_on(world), 0.1 * (kGravity + (v - before) / kStep), 1e-3) << t;
        before = v;
    }
}

TEST(Driven, ThrowsWhatItLeavesBehind) {
    // once the platform's downward acceleration exceeds g, the block is in free flight
    World world = with_block();
    constexpr double kAmplitude = 0.02, kOmega = 40;
    double highest = 0;
    bool flew = false;
    for (int i = 1; i < 200; ++i) {
        world.drive(kPlatform, {Quat::Identity(), swing({0, 0, kAmplitude}, kOmega, i * kStep)});
        world.step(kStep);
        flew = flew || load_on(world) == 0;
        highest = std::max(highest, world.state(kBlock).X_WB.p.z() - 0.02);
    }
    EXPECT_TRUE(flew);
    // the block leaves the platform where A w^2 cos(w t) / 2 = -g, still moving upward
    const double c = -2 * kGravity / (kAmplitude * kOmega * kOmega);
    const double z = kAmplitude * (1 - c) / 2;
    const double v = kAmplitude * kOmega * std::sqrt(1 - c * c) / 2;
    EXPECT_NEAR(highest, z + v * v / (2 * kGravity), 3e-4);
}

TEST(Driven, GivesWhatBouncesOffItTwiceItsSpeed) {
    for (const double restitution : {0.5, 1.0}) {
        scene::Scene scene;
        scene.gravity.setZero();
        scene.bodies = {platform(), block({0, 0, 0.05})};
        scene.bodies[1].surface.restitution = restitution;
        World world(scene, awake());
        world.activate();
        constexpr double kSpeed = 0.5;
        for (int i = 1; i <= 150; ++i) {
            world.drive(kPlatform, {Quat::Identity(), {0, 0, -0.02 + kSpeed * kStep * i}});
            world.step(kStep);
        }
        EXPECT_NEAR(world.state(kBlock).v_WB.z(), (1 + restitution) * kSpeed, 0.01 * kSpeed);
    }
}

TEST(Driven, DragsWhatStandsOnItUpToFriction) {
    for (const double acceleration : {4.0, 7.0}) {
        World world = with_block();
        double x = 0;
        for (int i = 1; i <= 300; ++i) {
            x = acceleration * (i * kStep) * (i * kStep) / 2;
            world.drive(kPlatform, {Quat::Identity(), {x, 0, -0.02}});
            world.step(kStep);
        }
        const double dragged = std::min(acceleration, 0.5 * kGravity);
        EXPECT_NEAR(world.state(kBlock).v_WB.x(), dragged * 0.3, 0.01 * dragged * 0.3)
            << acceleration;
    }
}

TEST(Driven, CarriesRound) {
    World world = make({platform(), block({0.1, 0, 0.02}, 0.8)}, awake());
    constexpr double kSpeed = 3;  // [rad/s], i.e. 0.9 m/s^2 towards the axis
    for (int i = 1; i <= 500; ++i) {
        const double ramp = std::min(1.0, i / 200.0);
        const Quat before = world.state(kPlatform).X_WB.R;
        const Quat turn(Eigen::AngleAxisd(ramp * kSpeed * kStep, Vec3::UnitZ()));
        world.drive(kPlatform, {turn * before, {0, 0, -0.02}});
        world.step(kStep);
    }
    EXPECT_NEAR(world.state(kPlatform).w_WB.z(), kSpeed, 1e-9);
    const Vec3& p = world.state(kBlock).X_WB.p;
    EXPECT_NEAR(p.head<2>().norm(), 0.1, 5e-4);
    EXPECT_NEAR(std::atan2(p.y(), p.x()), kSpeed * (0.3 + 0.1), 2e-3);
}

TEST(Driven, KeepsWhatLiesOnATurntableWhereItIs) {
    // another block lies on top, and needs a sixth of the available friction
    for (size_t i = 0; i < enum_names(contact::Solver{}).size(); ++i) {
        frame::DynamicsSettings settings = awake();
        settings.solver = static_cast<contact::Solver>(i);
        SCOPED_TRACE(std::string(enum_name(settings.solver)));
        scene::Body top = block({0.05, 0.01, 0.06}, 0.5);
        top.name = "top";
        World world = make({platform(), block({0.05, 0, 0.02}, 0.5), top}, settings);
        constexpr double kRate = 4;    // [rad/s]
        constexpr double kRise = 0.5;  // [s]
        double angle = 0;
        int unbalanced = 0;
        for (int step = 0; step < 3000; ++step) {
            angle += kStep * kRate * std::min(1.0, step * kStep / kRise);
            world.drive(kPlatform, {Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ())), {0, 0, -0.02}});
            world.step(kStep);
            unbalanced += world.balance().unbalanced;
        }
        EXPECT_EQ(unbalanced, 0);
        const Quat back(Eigen::AngleAxisd(-angle, Vec3::UnitZ()));
        EXPECT_LT((back * world.state(kBlock).X_WB.p - Vec3(0.05, 0, 0.02)).norm(), 1e-5);
        EXPECT_LT((back * world.states()[2].X_WB.p - Vec3(0.05, 0.01, 0.06)).norm(), 1e-5);
    }
}

TEST(Driven, IsHandedOverAndFliesOnWhenItIsLetGo) {
    World world = make({table(), block({0, 0, 0.3})}, awake());
    for (int i = 1; i <= 100; ++i) {
        world.drive(kBlock, {Quat::Identity(), {0.4 * i * kStep, 0, 0.3}});
        world.step(kStep);
        EXPECT_NEAR(world.state(kBlock).X_WB.p.z(), 0.3, 1e-12);
    }
    for (int i = 1; i <= 100; ++i) world.step(kStep);
    EXPECT_NEAR(world.state(kBlock).X_WB.p.x(), 0.08, 1e-9);
    EXPECT_NEAR(world.state(kBlock).v_WB.z(), -kGravity * 0.1, 1e-9);
}

TEST(Driven, WakesWhatSleepsOnIt) {
    World world = make({platform(), block({0, 0, 0.02})});
    for (int i = 0; i < 1500; ++i) world.step(kStep);
    EXPECT_FALSE(world.state(kBlock).awake);
    for (int i = 1; i <= 50; ++i) {
        world.drive(kPlatform, {Quat::Identity(), {0, 0, -0.02 + 1e-4 * i}});
        world.step(kStep);
    }
    EXPECT_NEAR(world.state(kBlock).X_WB.p.z(), 0.025, 5e-6);
}

TEST(Driven, AllocatesNothing) {
    World world = with_block();
    world.step(kStep);
    const testing::AllocationGuard guard;
    for (int i = 1; i < 100; ++i) {
        world.drive(kPlatform, {Quat::Identity(), {0, 0, -0.02 + 1e-5 * i}});
        world.step(kStep);
    }
    EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace dihaptic::dynamics::drive_test
