#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "haptics/finger.h"
#include "haptics/limiter.h"

namespace dihaptic::haptics::haptics_test {
namespace {

constexpr double kStep = 1e-3;

TEST(Limiter, CutsMagnitudeAndKeepsDirection) {
    Limiter limiter(2, 1e9);
    unsigned flags = 0;
    EXPECT_LT((limiter.limit({3, 4, 0}, kStep, flags) - Vec3(1.2, 1.6, 0)).norm(), 1e-15);
    EXPECT_EQ(flags, kForceLimited);
    flags = 0;
    EXPECT_EQ(limiter.limit({1, 0, 0}, kStep, flags), Vec3(1, 0, 0));
    EXPECT_EQ(flags, 0u);
}

TEST(Limiter, CutsChange) {
    Limiter limiter(100, 500);  // half a newton per tick
    unsigned flags = 0;
    Vec3 last = Vec3::Zero();
    for (int i = 0; i < 10; ++i) {
        const Vec3 now = limiter.limit({0, 0, 3}, kStep, flags);
        EXPECT_LE((now - last).norm(), 0.5 + 1e-12);
        last = now;
    }
    EXPECT_EQ(flags, kRateLimited);
    EXPECT_EQ(last, Vec3(0, 0, 3));
}

TEST(Limiter, HoldsNoForceUpForLongerThanATenthOfASecond) {
    Limiter limiter(10, 85);
    unsigned flags = 0;
    for (int i = 0; i < 200; ++i) limiter.limit({0, 0, 10}, kStep, flags);
    int ticks = 0;
    while (limiter.limit(Vec3::Zero(), kStep, flags) != Vec3::Zero()) ++ticks;
    EXPECT_LE(ticks, 100);
    EXPECT_GE(ticks, 99);
}

TEST(Limiter, DropsToZeroAtOnceAndForGoodOnWhatIsNoNumber) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        Limiter limiter(10, 500);
        unsigned flags = 0;
        for (int i = 0; i < 10; ++i) limiter.limit({0, 0, 5}, kStep, flags);
        flags = 0;
        EXPECT_EQ(limiter.limit({0, bad, 0}, kStep, flags), Vec3::Zero());
        EXPECT_EQ(flags, kNotFinite);
        EXPECT_EQ(limiter.limit({0, 0, 1}, kStep, flags), Vec3::Zero());
        EXPECT_TRUE(limiter.faulted());
    }
}

/// A finger in front of a fixed wall whose face is at x = 0.
struct Scene {
    scene::Finger finger;
    World world;
    BodyIndex proxy;

    static scene::Scene wall() {
        scene::Scene scene;
        scene::Body body;
        body.name = "wall";
        body.shape = scene::Shape::box({0.2, 1, 1});
        body.position = {0.1, 0, 0};
        body.fixed = true;
        body.friction = 0.5;
        scene.bodies = {body};
        return scene;
    }
    Scene() : world(wall(), {}) {
        finger.name = "index";
        finger.shape = scene::Shape::box({0.005, 0.02, 0.02});
        finger.friction = 0.5;
        proxy = world.add_proxy(finger, {-0.05, 0, 0});
        world.activate();
    }
    Vec3 tick(Finger& f, const frame::Handle& handle) {
        f.begin_tick(world, handle, kStep);
        f.before_step(world, handle, kStep);
        world.step(kStep);
        f.after_step(world, handle);
        return f.force(world, handle, kStep);
    }
};

frame::CouplingSettings implicit(double k) {
    frame::CouplingSettings settings;
    settings.stiffness = k;
    return settings;
}

TEST(ImplicitCoupling, LeavesTheHandFreeInFreeSpaceAndTheProxyFollows) {
    Scene s;
    Finger finger(s.finger, s.proxy, implicit(1000), 8.5);
    for (int i = 0; i < 300; ++i) {
        const double y = 0.1 * i * kStep;
        EXPECT_EQ(s.tick(finger, {{-0.05, y, 0}, {0, 0.1, 0}}), Vec3::Zero());
    }
    EXPECT_NEAR(s.world.state(s.proxy).X_WB.p.y(), 0.03, 2e-4);
}

TEST(ImplicitCoupling, PressesAWallWithStiffnessTimesDepth) {
    for (const double k : {300.0, 4000.0}) {
        Scene s;
        Finger finger(s.finger, s.proxy, implicit(k), 8.5);
        Vec3 f;
        const double depth = 0.01;
        for (int i = 0; i < 2000; ++i) {
            const double x = std::min(-0.05 + 0.1 * i * kStep, depth - 0.0025);
            f = s.tick(finger, {{x, 0, 0}, {x < depth - 0.0025 ? 0.1 : 0, 0, 0}});
        }
        EXPECT_NEAR(f.x() / (-k * depth), 1, 1e-4);
        EXPECT_NEAR(f.tail<2>().norm(), 0, 1e-6);
        EXPECT_TRUE(finger.touch().touching);
        EXPECT_LT((finger.touch().n_W - Vec3(-1, 0, 0)).norm(), 1e-9);
        EXPECT_NEAR(finger.touch().friction, 0.5, 1e-12);
    }
}

TEST(ImplicitCoupling, FrictionHoldsTheProxyUntilTheHandLeavesItsCone) {
    Scene s;
    Finger finger(s.finger, s.proxy, implicit(1000), 8.5);
    Vec3 f;
    double largest = 0;
    for (int i = 0; i < 3000; ++i) {
        const double x = std::min(-0.05 + 0.1 * i * kStep, 0.0075);  // 10 mm deep, i.e. 10 N
        const double y = i < 1000 ? 0 : 0.01 * (i - 1000) * kStep;  // then along the wall, to 20 mm
        f = s.tick(finger, {{x, y, 0}, {0, i < 1000 ? 0 : 0.01, 0}});
        largest = std::max(largest, std::abs(f.y()));
        if (i == 1300) {
            EXPECT_NEAR(s.world.state(s.proxy).X_WB.p.y(), 0, 1e-6);
            EXPECT_NEAR(f.y(), -3, 0.02);
        }
    }
    EXPECT_NEAR(largest, 0.5 * 10, 0.05);
    EXPECT_NEAR(f.y(), -5, 0.05);  // the proxy slides behind the hand
    EXPECT_NEAR(s.world.state(s.proxy).X_WB.p.y(), 0.02 - 0.005, 3e-4);
}

TEST(ImplicitCoupling, BetweenStepsTheForceFollowsTheHandWithinTheCone) {
    Scene s;
    Finger finger(s.finger, s.proxy, implicit(1000), 8.5);
    for (int i = 0; i < 2000; ++i)
        s.tick(finger, {{std::min(-0.05 + 0.1 * i * kStep, 0.0075), 0, 0}, Vec3::Zero()});
    EXPECT_NEAR(finger.force(s.world, {{0.0085, 0, 0}, Vec3::Zero()}, kStep).x(), -11, 0.01);
    EXPECT_EQ(finger.force(s.world, {{-0.01, 0, 0}, Vec3::Zero()}, kStep).norm(),
              0);  // a wall must not pull
    const Vec3 across = finger.force(s.world, {{0.0075, 0.05, 0}, Vec3::Zero()}, kStep);
    EXPECT_NEAR(across.y(), -0.5 * -across.x(), 1e-9);  // it slides
}

TEST(DualSpring, SmoothsTheForceByItsFilter) {
    Scene s;
    frame::CouplingSettings settings;
    settings.kind = frame::CouplingKind::dual_spring;
    settings.stiffness = 100;
    settings.damping = 0;
    Finger finger(s.finger, s.proxy, settings, 8.5);
    const frame::Handle handle{{-0.04, 0, 0}, Vec3::Zero()};
    // the proxy stands still during the first force, 10 mm behind the handle
    finger.begin_tick(s.world, handle, kStep);
    const Vec3 first = finger.force(s.world, handle, kStep);
    finger.begin_tick(s.world, handle, kStep);
    const Vec3 second = finger.force(s.world, handle, kStep);
    EXPECT_NEAR(first.x(), 0.2 * 100 * -0.01, 1e-12);
    EXPECT_NEAR(second.x(), (0.2 + 0.8 * 0.2) * 100 * -0.01, 1e-12);
}

TEST(DualSpring, DragsTheHandInFreeMotion) {
    Scene s;
    frame::CouplingSettings settings;
    settings.kind = frame::CouplingKind::dual_spring;
    Finger finger(s.finger, s.proxy, settings, 8.5);
    Vec3 f;
    for (int i = 0; i < 400; ++i) {
        const double t = i * kStep;
        f = s.tick(finger, {{-0.05, 2 * t * t, 0}, {0, 4 * t, 0}});
    }
    // a proxy of 20 g at 4 m/s^2, whose spring is ten times as stiff as the hand's; the damper adds
    // a little, because the velocity of the proxy is a step late
    EXPECT_NEAR(f.y(), -0.02 * 4 / 10, 0.001);
}

frame::CouplingSettings velocity_impulse(double k) {
    frame::CouplingSettings settings = implicit(k);
    settings.kind = frame::CouplingKind::velocity_impulse;
    return settings;
}

TEST(VelocityImpulse, TakesTheProxyToTheHandleInOneStepAndLeavesTheHandFree) {
    Scene s;
    Finger finger(s.finger, s.proxy, velocity_impulse(1000), 8.5);
    for (int i = 0; i < 300; ++i) {
        const double t = i * kStep;
        const frame::Handle handle{{-0.05, 2 * t * t, 0.001 * std::sin(40 * t)}, Vec3::Zero()};
        EXPECT_EQ(s.tick(finger, handle), Vec3::Zero());
        EXPECT_LT((s.world.state(s.proxy).X_WB.p - handle.p_WH).norm(), 1e-12) << i;
    }
}

TEST(VelocityImpulse, IsBoundedByWhatTheHandMayFeel) {
    const double k = 4000;
    const double max_force = 2;
    Scene s;
    Finger finger(s.finger, s.proxy, velocity_impulse(k), max_force);
    // in free space: the proxy follows a handle that has jumped far away with at most max_force
    const double mass = kStep * kStep * k * 1.5;  // h^2 k + h c, c = k h / 2
    double v = 0;
    for (int i = 0; i < 5; ++i) {
        s.tick(finger, {{-0.05, 0.1, 0}, Vec3::Zero()});
        const double faster = s.world.state(s.proxy).v_WB.y() - v;
        EXPECT_NEAR(faster * mass / kStep, max_force, 1e-9);
        v += faster;
    }
    // in contact: at a depth of 10 mm, the spring alone would give 40 N
    for (int i = 0; i < 2000; ++i)
        s.tick(finger, {{std::min(-0.05 + 0.1 * i * kStep, 0.0075), 0, 0}, Vec3::Zero()});
    EXPECT_NEAR(finger.touch().normal_force, max_force, 1e-6);
}

TEST(VelocityImpulse, PressesAWallWithStiffnessTimesDepthAndGivesItTheSame) {
    for (const double k : {300.0, 4000.0}) {  // less and more than the finger's mass of one gram
        Scene s;
        Finger finger(s.finger, s.proxy, velocity_impulse(k), 1e3);
        Vec3 f;
        for (int i = 0; i < 2000; ++i)
            f = s.tick(finger, {{std::min(-0.05 + 0.1 * i * kStep, 0.0075), 0, 0}, Vec3::Zero()});
        EXPECT_NEAR(f.x() / (-k * 0.01), 1, 1e-6);
        EXPECT_NEAR(finger.touch().normal_force / (k * 0.01), 1, 1e-6);
    }
}

/// A handle that runs into the wall, stays, leaves, returns within the onset time, stays, and
/// leaves.
frame::Handle there_and_back(int tick) {
    const std::array<std::pair<int, double>, 7> way{{{0, -0.05},
                                                     {100, 0.0075},
                                                     {300, 0.0075},
                                                     {400, -0.005},
                                                     {415, -0.005},
                                                     {515, 0.0075},
                                                     {715, 0.0075}}};
    for (size_t i = 1; i < way.size(); ++i) {
        if (tick >= way[i].first) continue;
        const auto [t0, x0] = way[i - 1];
        const auto [t1, x1] = way[i];
        const double v = (x1 - x0) / ((t1 - t0) * kStep);
        return {{x0 + v * (tick - t0) * kStep, 0, 0}, {v, 0, 0}};
    }
    return {{way.back().second, 0, 0}, Vec3::Zero()};
}

class Onsets : public ::testing::TestWithParam<frame::CouplingKind> {};
INSTANTIATE_TEST_SUITE_P(Couplings, Onsets,
                         ::testing::Values(frame::CouplingKind::implicit,
                                           frame::CouplingKind::dual_spring,
                                           frame::CouplingKind::velocity_impulse),
                         [](const auto& of) { return std::string(enum_name(of.param)); });

TEST_P(Onsets, SoftenTouchingAndTouchingAgainWithoutAStepAndKeepTheEquilibrium) {
    const double k = 1000;
    const double time = 0.05;
    frame::CouplingSettings settings = implicit(k);
    settings.kind = GetParam();
    settings.onset = time;
    const bool dual = GetParam() == frame::CouplingKind::dual_spring;
    if (dual) settings.smoothing = 1;
    Scene s;
    Finger soft(s.finger, s.proxy, settings, 1e3);
    Scene h;
    settings.onset = 0;
    Finger hard(h.finger, h.proxy, settings, 1e3);
    Vec3 last = Vec3::Zero();
    int touches = 0;
    int ticks = 0;  // number of ticks of the current touch
    for (int i = 0; i < 715; ++i) {
        const frame::Handle handle = there_and_back(i);
        const Vec3 f = s.tick(soft, handle);
        const Vec3 f_hard = h.tick(hard, handle);
        // share times k v h and c v while the handle moves, plus the growth of the share at 10 mm;
        // with the dual spring, the proxy bounces, and each touch has its own step
        const double step = k * 0.57 * kStep * 1.5 + 0.9 * kStep / time * k * 0.01;
        EXPECT_LT((f - last).norm(), dual ? 2 * step : step) << i;
        last = f;
        const bool touching = soft.touch().touching;
        ticks = touching ? ticks + 1 : 0;
        if (ticks == 1 && ++touches == 1 && !dual) {
            EXPECT_LT(-f.x(), Onset::kFirstShare * k * 0.57 * kStep * 1.5);
        }
        if ((i > 200 && i < 300) || i > 700) {
            EXPECT_NEAR(f.x() / f_hard.x(), 1, 1e-9);
        } else if (ticks > 2 && !dual) {
            // once the proxy stands still, the force on the wall is that of the handle: the mass is
            // scaled too
            EXPECT_NEAR(soft.touch().normal_force, -f.x(), 1e-6) << i;
        }
    }
    if (!dual) {
        EXPECT_EQ(touches, 2);
    }
}

TEST(Coupling, DefaultDampingCancelsTheHoldOfOneSample) {
    EXPECT_DOUBLE_EQ(damping(implicit(1000), 1e-3), 0.5);
    frame::CouplingSettings given = implicit(1000);
    given.damping = 2;
    EXPECT_EQ(damping(given, 1e-3), 2);
}

}  // namespace
}  // namespace dihaptic::haptics::haptics_test
