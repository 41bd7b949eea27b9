#include "haptics/force_guard.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "haptics/soft_start.h"

namespace dihaptic::haptics::force_guard_test {
namespace {

constexpr double kTick = 1e-3;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

frame::DeviceInfo device(double continuous_force) {
    frame::DeviceInfo info;
    info.peak_force = 8.5;
    info.continuous_force = continuous_force;
    return info;
}

TEST(Heating, FallsFromThePeakToTheContinuousForceAsTheClosedFormSays) {
    // at the largest allowed force, f^2 - f_c^2 decays with the time constant tau f_c^2 / f_p^2
    const double peak = 8.5, continuous = 1.4, tau = 10;
    Heating heating(peak, continuous, tau);
    double last = peak;
    for (int i = 0; i < 20000; ++i) {
        const double force = heating.most_force();
        const double t = i * kTick;
        const double excess = (peak * peak - continuous * continuous) *
                              std::exp(-t * peak * peak / (continuous * continuous * tau));
        ASSERT_NEAR(force, std::sqrt(continuous * continuous + excess), 2e-3 * force) << t;
        ASSERT_LE(force, last);
        ASSERT_LE(last - force, 0.02);  // smooth: at most 20 N/s
        last = force;
        heating.add({force, 0, 0}, kTick);
        ASSERT_LE(heating.mean_square(), continuous * continuous * (1 + 1e-12));
    }
    EXPECT_NEAR(last, continuous, 1e-6);
}

TEST(Heating, NeverCutsWhatCanBeHeldForLong) {
    Heating heating(8.5, 1.4, 10);
    for (int i = 0; i < 200000; ++i) {
        ASSERT_GE(heating.most_force(), 1.399);
        heating.add({0, 1.399, 0}, kTick);
    }
}

TEST(Heating, BearsMoreForAWhileAndCools) {
    // a force of 2 N is cut where f_c^2 + (f_p^2 - f_c^2) (1 - q / f_c^2) = 4, q = 4 (1 - exp(-t /
    // tau))
    Heating heating(8.5, 1.4, 10);
    int ticks = 0;
    for (; heating.most_force() > 2; ++ticks) heating.add({2, 0, 0}, kTick);
    const double held = 1.4 * 1.4;
    const double q = held * (1 - (4 - held) / (8.5 * 8.5 - held));
    EXPECT_NEAR(ticks * kTick, -10 * std::log(1 - q / 4), 2e-3);
    for (int i = 0; i < 60000; ++i) heating.add(Vec3::Zero(), kTick);
    EXPECT_NEAR(heating.most_force(), 8.5, 0.02);
}

TEST(Heating, LimitsNothingWhereNothingIsKnown) {
    for (Heating heating : {Heating(), Heating(8.5, kInfinite, 10), Heating(kInfinite, 1.4, 10),
                            Heating(8.5, 8.5, 10)}) {
        for (int i = 0; i < 10000; ++i) heating.add({8.5, 0, 0}, kTick);
        EXPECT_EQ(heating.most_force(), kInfinite);
    }
}

TEST(WorkspaceWall, PushesInwardInProportionToTheDepth) {
    const WorkspaceWall wall({{{}, Vec3(0.2, 0.1, 0.1)}}, 500, kTick);
    EXPECT_EQ(wall.force({0.1, -0.05, 0.05}, {1, 1, 1}), Vec3::Zero());
    EXPECT_LT((wall.force({0.102, -0.051, 0}, Vec3::Zero()) - Vec3(-1, 0.5, 0)).norm(), 1e-12);
    // damping c = k h / 2
    EXPECT_NEAR(wall.force({0.102, 0, 0}, {0.4, 0, 0}).x(), -1.1, 1e-12);
    EXPECT_NEAR(wall.force({-0.102, 0, 0}, {-0.4, 0, 0}).x(), 1.1, 1e-12);
    // the force is never outward, however fast the handle returns
    EXPECT_EQ(wall.force({0.102, 0, 0}, {-50, 0, 0}).x(), 0);
}

TEST(WorkspaceWall, IsNoneWithoutABoxOrStiffness) {
    EXPECT_EQ(WorkspaceWall({}, 500, kTick).force({9, 9, 9}, Vec3::Zero()), Vec3::Zero());
    EXPECT_EQ(WorkspaceWall({{{}, Vec3(0.1, 0.1, 0.1)}}, 0, kTick).force({9, 9, 9}, Vec3::Zero()),
              Vec3::Zero());
}

TEST(SoftStart, RisesFromZeroWhereThereIsAForce) {
    SoftStart start(0.1);
    for (int i = 0; i < 100; ++i) EXPECT_NEAR(start.share(true, true, kTick), i / 100.0, 1e-12);
    EXPECT_EQ(start.share(true, true, kTick), 1);
}

TEST(SoftStart, IsOverOnceNothingIsAsked) {
    SoftStart start(0.1);
    EXPECT_EQ(start.share(true, true, kTick), 0);
    EXPECT_EQ(start.share(true, false, kTick), 1);
    EXPECT_EQ(start.share(true, true, kTick), 1);
}

TEST(SoftStart, BeginsAgainWhenTheSwitchIsPressedAgain) {
    SoftStart start(0.1);
    EXPECT_EQ(start.share(true, false, kTick), 1);
    EXPECT_EQ(start.share(false, true, kTick), 0);
    for (int i = 0; i < 100; ++i) EXPECT_NEAR(start.share(true, true, kTick), i / 100.0, 1e-12);
}

TEST(SoftStart, CanBeNone) {
    EXPECT_EQ(SoftStart(0).share(true, true, kTick), 1);
}

TEST(ForceGuard, DropsAtOnceWithoutTheSwitchAndRisesAgainFromZero) {
    frame::SafetySettings settings;
    settings.max_force_rate = 100;  // 0.1 N per tick
    ForceGuard guard(settings, device(kInfinite), {}, kTick);
    unsigned flags = 0;
    for (int i = 0; i < 50; ++i) guard.limit({Vec3(2, 0, 0)}, true, 1, flags);
    EXPECT_EQ(guard.limit({Vec3(2, 0, 0)}, true, 1, flags).force.x(), 2);
    flags = 0;
    EXPECT_TRUE(guard.limit({Vec3(2, 0, 0)}, false, 0, flags).is_zero());
    EXPECT_EQ(flags & kSwitchedOff, unsigned{kSwitchedOff});
    flags = 0;
    EXPECT_NEAR(guard.limit({Vec3(2, 0, 0)}, true, 0.5, flags).force.x(), 0.1, 1e-12);
    EXPECT_EQ(flags, unsigned{kSoftStarted} | kRateLimited);
}

TEST(ForceGuard, SeesWhatIsNoNumberWithoutTheSwitchToo) {
    ForceGuard guard({}, device(kInfinite), {}, kTick);
    unsigned flags = 0;
    guard.limit({Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0)}, false, 0, flags);
    EXPECT_NE(flags & kNotFinite, 0u);
}

TEST(ForceGuard, KeepsTheWallsAxesWithTheDevice) {
    const Pose X_WD{rotation_xyz({0, 0, std::numbers::pi / 2}), {1, 0, 0}};
    ForceGuard guard({}, device(kInfinite), {{X_WD, Vec3(0.2, 0.1, 0.1)}}, kTick);
    unsigned flags = 0;
    // the handle is 2 mm beyond the box along D's x, which is the world's y
    const Vec3 p_WH(1, 0.102, 0);
    EXPECT_LT((guard.push({p_WH, Vec3::Zero()}, flags) - Vec3(0, -1, 0)).norm(), 1e-12);
    EXPECT_EQ(flags, unsigned{kPushedInward});
}

TEST(ForceGuard, CutsToWhatTheMotorsBear) {
    frame::SafetySettings settings;
    settings.heating_time = 1;
    ForceGuard guard(settings, device(1.4), {}, kTick);
    unsigned flags = 0;
    Wrench limited;
    for (int i = 0; i < 3000; ++i) limited = guard.limit({Vec3(0, 3, 0)}, true, 1, flags);
    EXPECT_NEAR(limited.force.y(), 1.4, 1e-6);
    EXPECT_EQ(flags & kHeatLimited, unsigned{kHeatLimited});
}

}  // namespace
}  // namespace dihaptic::haptics::force_guard_test
