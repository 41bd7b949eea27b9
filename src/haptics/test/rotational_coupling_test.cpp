#include "haptics/rotational_coupling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "haptics/finger.h"
#include "haptics/test/stops.h"

namespace dihaptic::haptics::rotational_coupling_test {
namespace {

constexpr double kStep = 1e-3;
constexpr double kGravity = 9.81;

/// A bar of 200 x 20 x 10 mm, held at its centre by a handle that can turn.
struct Bar {
    scene::Finger finger;
    World world;
    Finger proxy;

    static scene::Finger bar(double mass) {
        scene::Finger out;
        out.name = "bar";
        out.shape = scene::Shape::box({0.2, 0.02, 0.01});
        out.mass = mass;
        return out;
    }
    explicit Bar(const scene::Scene& scene, const frame::CouplingSettings& settings = {},
                 double mass = 0.001)
        : finger(bar(mass)),
          world(scene, {}),
          proxy(finger, world.add_proxy(finger, Vec3::Zero(), true), settings, 8.5) {
        world.activate();
        proxy.turn_with_handle(
            RotationalCoupling(settings, world.inertia(proxy.proxy()), Quat::Identity()));
        proxy.place(world, {});
    }
    /// Does one tick, and returns the torque on the handle.
    Vec3 tick(const frame::Handle& handle, bool steps = true, double step = kStep) {
        proxy.begin_tick(world, handle, step);
        if (steps) {
            proxy.before_step(world, handle, step);
            world.step(step);
            proxy.after_step(world, handle);
        }
        force = proxy.force(world, handle, kStep);
        return proxy.torque();
    }
    const dynamics::BodyState& state() const { return world.state(proxy.proxy()); }
    Vec3 force = Vec3::Zero();
};

frame::Handle turned(const Vec3& rotation, const Vec3& w = Vec3::Zero()) {
    frame::Handle out;
    out.R_WH = rotation_by(rotation);
    out.w_WH = w;
    return out;
}

TEST(RotationVector, IsTheInverseOfRotationBy) {
    for (const double angle : {0.0, 1e-14, 1e-7, 0.3, 3.1}) {
        const Vec3 r = angle * Vec3(1, -2, 0.5).normalized();
        EXPECT_LT((rotation_vector(rotation_by(r)) - r).norm(), 1e-15 + 1e-9 * angle) << angle;
    }
    // returns the shorter of the two rotations
    EXPECT_LT(
        (rotation_vector(rotation_by({0, 0, 4})) - Vec3(0, 0, 4 - 2 * std::numbers::pi)).norm(),
        1e-12);
    for (const Vec3& angles : {Vec3(0.3, -1.2, 2), Vec3(-2, std::numbers::pi / 2, 0.4)}) {
        const Quat R = rotation_xyz(angles);
        EXPECT_LT(angle_between(rotation_xyz(angles_xyz(R)), R), 1e-7);
    }
}

TEST(RotationalCoupling, FollowsAHandleInFreeSpaceThatFeelsNothing) {
    Bar bar{scene::Scene{}};
    const Vec3 w(1, -2, 3);
    Quat R = Quat::Identity();
    for (int i = 0; i < 300; ++i) {
        R = (rotation_by(kStep * w) * R).normalized();
        frame::Handle handle;
        handle.R_WH = R;
        handle.w_WH = w;
        EXPECT_EQ(bar.tick(handle), Vec3::Zero());
    }
    EXPECT_LT(angle_between(bar.state().X_WB.R, R), 1e-9);
    EXPECT_LT((bar.state().w_WB - w).norm(), 1e-7);
}

TEST(RotationalCoupling, IsTheSpringAndDamperOfTheStepsEndWhateverTheInertia) {
    // compare with backward Euler of I dw/dt = k r - c w about one axis
    frame::CouplingSettings settings;
    settings.turn_stiffness = 2;
    settings.turn_damping = 0.005;
    Bar bar(scene::Scene{}, settings, 0.5);
    const double I = bar.world.inertia(bar.proxy.proxy());
    // mean of the moments of the box
    EXPECT_NEAR(I, 0.5 / 12 * 2.0 / 3 * (0.2 * 0.2 + 0.02 * 0.02 + 0.01 * 0.01), 1e-9);
    double angle = 0, w = 0;
    double energy = 2 * 0.4 * 0.4 / 2;
    for (int i = 0; i < 500; ++i) {
        w = (I * w + kStep * 2 * (0.4 - angle)) / (I + kStep * 0.005 + kStep * kStep * 2);
        angle += kStep * w;
        bar.tick(turned({0, 0.4, 0}));
        ASSERT_NEAR(rotation_vector(bar.state().X_WB.R).y(), angle, 1e-9) << i;
        // the coupling never releases more energy than was put in
        const double now = I / 2 * bar.state().w_WB.squaredNorm() +
                           std::pow(0.4 - rotation_vector(bar.state().X_WB.R).y(), 2);
        ASSERT_LE(now, energy * (1 + 1e-12)) << i;
        energy = now;
    }
    EXPECT_LT(energy, 0.02);
}

TEST(RotationalCoupling, TurnsAgainstStopsWithStiffnessTimesAngle) {
    for (const double k : {0.3, 5.0}) {
        frame::CouplingSettings settings;
        settings.turn_stiffness = k;
        Bar bar(stops(), settings);
        Vec3 torque;
        for (int i = 1; i <= 500; ++i)
            torque = bar.tick(turned({0, 0.1 * std::min(i, 300) / 300, 0}));
        EXPECT_NEAR(torque.y() / (-k * 0.1), 1, 1e-3) << k;
        EXPECT_LT(std::hypot(torque.x(), torque.z()), 1e-5);
        EXPECT_LT(bar.force.norm(), 1e-4);  // the effect is a pure couple
        // once released, the handle feels nothing
        for (int i = 0; i < 100; ++i) torque = bar.tick(turned({0, -0.1, 0}));
        EXPECT_EQ(torque, Vec3::Zero());
    }
}

TEST(RotationalCoupling, CarriesWeightTimesDistance) {
    scene::Scene scene;
    scene::Body block;
    block.name = "block";
    block.shape = scene::Shape::box({0.02, 0.02, 0.02});
    block.position = {0.07, 0, 0.015};
    block.mass = 0.1;
    scene.bodies = {block};
    frame::CouplingSettings settings;
    settings.damping = 10;  // otherwise the block swings, since no hand damps it
    settings.turn_damping = 0.05;
    Bar bar(scene, settings);
    Vec3 torque;
    for (int i = 0; i < 1500; ++i) torque = bar.tick({});
    const Vec3 p_B = bar.world.state({0}).X_WB.p;
    EXPECT_GT(p_B.x(), 0.06);
    EXPECT_NEAR(torque.y() / (0.1 * kGravity * p_B.x()), 1, 1e-4);
    EXPECT_NEAR(bar.force.z() / (-0.1 * kGravity), 1, 1e-4);
    EXPECT_NEAR(rotation_vector(bar.state().X_WB.R).y(), torque.y() / 1.0, 1e-6);  // k_r = 1
}

/// Ratio of the last swing to the first one, after a small push, of a handle with inertia I and
/// damping b that a constant torque holds against its stops, if the coupling's spring is sampled
/// and held.
double swing_ratio(double k, double I, double b) {
    frame::CouplingSettings settings;
    settings.turn_stiffness = k;
    settings.turn_damping = 0;
    Bar bar(stops(), settings);
    const double rest = 0.01;
    const double push = k * rest;
    const double a = std::exp(-b * kStep / I);
    const double beta = I / b * (1 - a);
    double angle = rest * 1.05, w = 0;
    double first = 0, last = 0;
    for (int i = 0; i < 2000; ++i) {
        const double u = push + bar.tick(turned({0, angle, 0}, {0, w, 0})).y();
        angle += beta * w + u / b * (kStep - beta);
        w = a * w + u / b * (1 - a);
        const double off = std::abs(angle - rest) / rest;
        if (off > 0.5) return 1e9;  // the bar has left its stops
        if (i < 300) first = std::max(first, off);
        if (i >= 1700) last = std::max(last, off);
    }
    return last / first;
}

TEST(RotationalCoupling, IsStableUpToTheLimitOfAWall) {
    // x+ = x + beta v + (T - beta) u / b, v+ = a v + (1 - a) u / b, u = -k x: the product of the
    // eigenvalues is a + k (beta (1 - a) - a (T - beta)) / b, and equals 1 at the limit
    const double I = 1e-4, b = 0.002;
    const double a = std::exp(-b * kStep / I);
    const double beta = I / b * (1 - a);
    const double limit = b * (1 - a) / (beta * (1 - a) - a * (kStep - beta));
    EXPECT_NEAR(limit, 2 * b / kStep, 0.1 * 2 * b / kStep);
    EXPECT_LT(swing_ratio(0.97 * limit, I, b), 0.9);
    EXPECT_GT(swing_ratio(1.03 * limit, I, b), 1.1);
}

TEST(RotationalCoupling, IsFreshBetweenStepsAndNeverChangesItsSign) {
    Bar bar(stops());
    for (int i = 1; i <= 300; ++i) bar.tick(turned({0, 1e-4 * i, 0}), i % 10 == 1, 10 * kStep);
    bar.tick(turned({0, 0.03, 0}), true, 10 * kStep);
    EXPECT_NEAR(bar.tick(turned({0, 0.04, 0}), false, 10 * kStep).y(), -0.04, 1e-4);
    EXPECT_EQ(bar.tick(turned({0, -0.01, 0}), false, 10 * kStep), Vec3::Zero());
}

TEST(RotationalCoupling, IsAShareOfItselfDuringOnset) {
    frame::CouplingSettings settings;
    settings.onset = 0.1;
    Bar bar(stops(), settings);
    Vec3 torque = bar.tick(turned({0, 0.1, 0}));
    torque = bar.tick(turned({0, 0.1, 0}));
    EXPECT_LT(torque.norm(), 0.2 * 0.1);
    for (int i = 0; i < 200; ++i) torque = bar.tick(turned({0, 0.1, 0}));
    EXPECT_NEAR(torque.y(), -0.1, 1e-4);
}

TEST(RotationalCoupling, OfASoftPointFeelsTheTorsionThatItsGripHolds) {
    // a point presses on the top of a fixed block and is turned about the normal
    scene::Scene scene;
    scene::Body block;
    block.name = "block";
    block.shape = scene::Shape::box({0.1, 0.1, 0.1});
    block.position = {0, 0, -0.05};
    block.fixed = true;
    block.friction = 0.5;
    scene.bodies = {block};
    scene::Finger finger;
    finger.name = "index";
    finger.shape = scene::Shape::sphere(0.008);
    finger.friction = 0.5;
    for (const double radius : {0.006, 0.0}) {
        finger.torsion_radius = radius;
        scene.fingers = {finger};
        World world(scene, {});
        const BodyIndex body = world.add_point(finger, Vec3::Zero(), true);
        const frame::CouplingSettings settings;
        Finger point(SolvedPoint(scene, body, settings, {}), body);
        world.activate();
        point.turn_with_handle(RotationalCoupling(settings, 0, Quat::Identity()));
        frame::Handle handle;
        handle.p_WH = {0, 0, 0.001};
        point.place(world, handle);
        const auto tick = [&] {
            point.begin_tick(world, handle, kStep);
            point.before_step(world, handle, kStep);
            world.step(kStep);
            point.after_step(world, handle);
            return point.force(world, handle, kStep);
        };
        for (int i = 0; i < 200; ++i) {
            handle.p_WH.z() -= 2e-5;
            tick();
        }
        Vec3 force;
        for (int i = 0; i < 500; ++i) {
            handle.R_WH = rotation_by({0, 0, std::min(i, 300) * 1e-4});
            force = tick();
        }
        EXPECT_NEAR(force.z(), 3, 0.05);
        // 0.5 x 6 mm x 3 N = 9 mN m, less than the 30 mN m that 0.03 rad would give
        EXPECT_NEAR(point.torque().z(), -0.5 * radius * force.z(), 1e-6);
        EXPECT_LT(point.torque().head<2>().norm(), 1e-6);
    }
}

}  // namespace
}  // namespace dihaptic::haptics::rotational_coupling_test
