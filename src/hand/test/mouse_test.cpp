#include "hand/mouse.h"

#include <gtest/gtest.h>

#include "base/diagnostics.h"

namespace dihaptic::hand::mouse_test {
namespace {

const std::vector<std::string> kPair{"thumb", "index"};

HandSpec spec() {
    HandSpec out;
    out.centre = {0.01, 0.02, 0.03};
    out.aperture = 0.08;
    return out;
}

/// The servo's tick at `t` is the first that knows the goal.
void follow(MouseDriver& driver, const Posture& goal, double t) {
    driver.follow(goal);
    driver.target(0, t);
}

TEST(MouseDriver, RestsWhereTheSpecSaysUntilItIsMoved) {
    const MouseDriver driver(spec(), kPair);
    for (const double t : {0.0, 1.0, 100.0}) {
        EXPECT_TRUE(driver.target(0, t).p_WT.isApprox(Vec3(-0.03, 0.02, 0.03)));
        EXPECT_TRUE(driver.target(1, t).p_WT.isApprox(Vec3(0.05, 0.02, 0.03)));
        EXPECT_TRUE(driver.target(1, t).v_WT.isZero());
    }
}

/// Checks the closed form: after one time constant, the fraction (1 + 1) / e of the path is left,
/// and there is no overshoot.
TEST(MouseDriver, FollowsCriticallyDamped) {
    MouseDriver driver(spec(), kPair);
    Posture goal = driver.goal();
    goal.centre.z() += 0.1;
    follow(driver, goal, 1);
    const double z0 = 0.03;
    EXPECT_DOUBLE_EQ(driver.target(0, 1).p_WT.z(), z0);
    EXPECT_NEAR(driver.target(0, 1 + MouseDriver::kFollow).p_WT.z(),
                z0 + 0.1 * (1 - 2 / std::exp(1.0)), 1e-12);
    double before = z0;
    for (double t = 1; t < 2; t += 0.001) {
        const double z = driver.target(0, t).p_WT.z();
        EXPECT_GE(z, before);
        before = z;
    }
    EXPECT_NEAR(before, z0 + 0.1, 1e-8);
}

TEST(MouseDriver, ItsSpeedIsTheSlopeOfItsPlaceThroughChangesOfMind) {
    MouseDriver driver(spec(), kPair);
    Posture goal = driver.goal();
    const double h = 1e-6;
    double t = 0;
    for (int i = 0; i < 20; ++i) {
        goal.centre += Vec3(0.01, -0.02 * (i % 3), 0.03 * (i % 2));
        goal.aperture = 0.02 + 0.01 * (i % 5);
        goal.yaw += 0.3;
        goal.roll -= 0.2 * (i % 4);
        const FingerTarget old = driver.target(1, t);
        follow(driver, goal, t);
        // neither the position nor the velocity jumps
        EXPECT_LT((driver.target(1, t).p_WT - old.p_WT).norm(), 1e-12);
        EXPECT_LT((driver.target(1, t).v_WT - old.v_WT).norm(), 1e-10);
        for (int k = 0; k < 10; ++k, t += 0.003) {
            const Vec3 slope = (driver.target(1, t + h).p_WT - driver.target(1, t).p_WT) / h;
            EXPECT_LT((driver.target(1, t + h / 2).v_WT - slope).norm(), 1e-6);
        }
    }
}

/// Events arrive between ticks, some several to a tick, and the window's thread lags behind: the
/// targets are those of the newest goal, without a jump.
TEST(MouseDriver, DoesNotJumpHoweverLateAGoalArrives) {
    MouseDriver driver(spec(), kPair);
    Posture goal = driver.goal();
    const double h = 0.001;
    FingerTarget before = driver.target(0, 0);
    for (int tick = 1; tick < 500; ++tick) {
        if (tick % 37 == 0) {
            goal.centre.z() += 0.003;
            driver.follow(goal);
            goal.centre.z() += 0.003;
            driver.follow(goal);
        }
        const FingerTarget now = driver.target(0, h * tick);
        const double step = (now.p_WT - before.p_WT).norm();
        EXPECT_LT(std::abs(step - h * (now.v_WT + before.v_WT).norm() / 2), 1e-6);
        before = now;
    }
    EXPECT_NEAR(driver.target(0, 2).p_WT.z(), goal.centre.z(), 1e-9);
}

TEST(MouseDriver, TurnsAboutTheVerticalAndTheHandsOwnAxis) {
    MouseDriver driver(spec(), kPair);
    Posture goal = driver.goal();
    goal.yaw = M_PI / 2;
    follow(driver, goal, 0);
    EXPECT_LT((driver.target(1, 5).p_WT - Vec3(0.01, 0.06, 0.03)).norm(), 1e-9);
    goal.yaw = 0;
    goal.roll = M_PI / 2;
    follow(driver, goal, 5);
    EXPECT_LT((driver.target(1, 10).p_WT - Vec3(0.01, 0.02, -0.01)).norm(), 1e-9);
}

TEST(MouseDriver, MovesTheFingersOfSeveralHandsTogether) {
    HandSpec hands = spec();
    FingerPlace index;
    index.name = "index";
    index.side = {1, 0, 0};
    index.centre = Vec3(0.2, 0, 0);
    index.aperture = 0.1;
    hands.fingers.push_back(index);
    MouseDriver driver(hands, kPair);
    EXPECT_TRUE(driver.target(1, 0).p_WT.isApprox(Vec3(0.25, 0, 0)));
    Posture goal = driver.goal();
    goal.centre.z() += 0.1;
    goal.aperture -= 0.02;
    follow(driver, goal, 0);
    EXPECT_LT((driver.target(1, 5).p_WT - Vec3(0.24, 0, 0.1)).norm(), 1e-9);
    EXPECT_LT((driver.target(0, 5).p_WT - Vec3(-0.02, 0.02, 0.13)).norm(), 1e-9);
}

TEST(MouseDriver, AimsBehindItselfNoFurtherThanItsBound) {
    MouseDriver driver(spec(), kPair);
    Posture goal = driver.goal();
    goal.aperture = -0.1;
    follow(driver, goal, 0);
    EXPECT_EQ(driver.goal().aperture, MouseDriver::kTightest);
}

TEST(MouseDriver, RefusesFingersThatThereAreNot) {
    HandSpec wrong = spec();
    wrong.fingers.push_back({"toe", {1, 0, 0}});
    EXPECT_THROW(MouseDriver(wrong, kPair), Error);
}

}  // namespace
}  // namespace dihaptic::hand::mouse_test
