#include "hand/script.h"

#include <gtest/gtest.h>

#include "hand/finger.h"
#include "model/minimum_jerk.h"

namespace dihaptic::hand::script_test {
namespace {

HandSpec spec() {
    HandSpec hand;
    hand.centre = {0.01, 0, 0.02};
    hand.aperture = 0.1;
    hand.script = {{"close", 1, 0.04, Vec3::Zero(), false},
                   {"lift", 2, {}, {0, 0, 0.1}, false},
                   {"slide", 1, {}, {0.2, 0, 0}, true}};
    return hand;
}

TEST(Script, MovesApertureAndCentreByMinimumJerk) {
    const ScriptDriver driver(spec(), {"thumb", "index"});
    EXPECT_EQ(driver.duration(), 4);
    EXPECT_LT((driver.target(0, 0).p_WT - Vec3(-0.04, 0, 0.02)).norm(), 1e-15);
    EXPECT_LT((driver.target(1, 0.5).p_WT - Vec3(0.01 + 0.035, 0, 0.02)).norm(), 1e-15);
    EXPECT_NEAR(driver.target(1, 0.5).v_WT.x(), -0.03 * model::kMinimumJerkPeak, 1e-15);
    EXPECT_LT((driver.target(0, 3).p_WT - Vec3(-0.01, 0, 0.12)).norm(), 1e-15);
    EXPECT_NEAR(driver.target(0, 2).v_WT.z(), 0.05 * model::kMinimumJerkPeak, 1e-15);
    EXPECT_NEAR(driver.target(0, 3.5).v_WT.x(), 0.2, 1e-15);  // steady
    EXPECT_EQ(driver.target(0, 9).v_WT, Vec3::Zero());        // stays where the script ended
}

TEST(Script, VelocityIsTheDerivativeOfPosition) {
    const ScriptDriver driver(spec(), {"thumb", "index"});
    const double h = 1e-6;
    for (double t = 0.05; t < 4; t += 0.1) {
        const Vec3 slope = (driver.target(1, t + h).p_WT - driver.target(1, t - h).p_WT) / (2 * h);
        EXPECT_LT((slope - driver.target(1, t).v_WT).norm(), 1e-7) << t;
    }
}

/// A throw: the hand rises to a speed of 1.2 m/s, and rises further while it opens and turns; then
/// the index finger does the same alone.
HandSpec throwing() {
    HandSpec hand = spec();
    ScriptStep up;
    up.name = "up";
    up.duration = 0.4;
    up.move = {0, 0, 0.2};
    up.end_velocity = {0, 0, 1.2};
    ScriptStep open;
    open.name = "open";
    open.duration = 0.2;
    open.move = {0, 0, 0.1};
    open.aperture = 0.2;
    open.turn = {0, 0, 0.5};
    ScriptStep index = open;
    index.name = "index";
    index.fingers = {"index"};
    hand.script = {up, open, index};
    return hand;
}

TEST(Script, PassesFromStepToStepAtTheSpeedAskedFor) {
    const ScriptDriver driver(throwing(), {"thumb", "index"});
    for (const double t : {0.4 - 1e-9, 0.4}) {
        EXPECT_LT((driver.target(0, t).p_WT - Vec3(-0.04, 0, 0.22)).norm(), 1e-8);
        EXPECT_LT((driver.target(0, t).v_WT - Vec3(0, 0, 1.2)).norm(), 1e-8) << t;
    }
    const double h = 1e-7;
    for (double t = 0.05; t < 0.8; t += 0.1) {
        for (const int finger : {0, 1}) {
            const Vec3 slope =
                (driver.target(finger, t + h).p_WT - driver.target(finger, t - h).p_WT) / (2 * h);
            EXPECT_LT((slope - driver.target(finger, t).v_WT).norm(), 1e-7) << t;
        }
    }
}

TEST(Script, TurnsTheHandAboutItsCentre) {
    const ScriptDriver driver(throwing(), {"thumb", "index"});
    const Vec3 arm(0.1 * std::cos(0.5), 0.1 * std::sin(0.5), 0);
    EXPECT_LT((driver.target(1, 0.6).p_WT - Vec3(0.01, 0, 0.32) - arm).norm(), 1e-15);
    EXPECT_LT((driver.target(0, 0.6).p_WT - Vec3(0.01, 0, 0.32) + arm).norm(), 1e-15);
    // the two turns add up
    const Vec3 twice(0.1 * std::cos(1), 0.1 * std::sin(1), 0);
    EXPECT_LT((driver.target(1, 0.8).p_WT - Vec3(0.01, 0, 0.42) - twice).norm(), 1e-15);
}

TEST(Script, MovesTheNamedFingersOnly) {
    const ScriptDriver driver(throwing(), {"thumb", "index"});
    EXPECT_EQ(driver.target(0, 0.65).p_WT, driver.target(0, 0.8).p_WT);
    EXPECT_EQ(driver.target(0, 0.7).v_WT, Vec3::Zero());
    EXPECT_GT(driver.target(1, 0.7).v_WT.z(), 0.5);
}

TEST(Script, HasAsManyHandsAsItsFingersSay) {
    HandSpec hand = spec();
    hand.fingers = {{"ring", {0, 1, 0}, Vec3::Zero(), {}, Vec3(0, 0, 0.3), 0.06}};
    hand.script.resize(2);
    hand.script[1].fingers = {"ring"};
    const ScriptDriver driver(hand, {"thumb", "index", "ring"});
    EXPECT_LT((driver.target(2, 0).p_WT - Vec3(0, 0.03, 0.3)).norm(), 1e-15);
    EXPECT_LT((driver.target(2, 3).p_WT - Vec3(0, 0.02, 0.4)).norm(), 1e-15);
    EXPECT_LT((driver.target(0, 3).p_WT - Vec3(-0.01, 0, 0.02)).norm(), 1e-15);
}

TEST(Script, NamesItsPhases) {
    const ScriptDriver driver(spec(), {"thumb", "index"});
    ASSERT_EQ(driver.phases().size(), 3u);
    EXPECT_EQ(driver.phases()[1].name, "lift");
    EXPECT_EQ(driver.phases()[1].start, 1);
    EXPECT_EQ(driver.phases()[1].end, 3);
}

TEST(Script, OneFingerIsTheHand) {
    const ScriptDriver driver(spec(), {"index"});
    EXPECT_LT((driver.target(0, 0).p_WT - Vec3(0.01, 0, 0.02)).norm(), 1e-15);
}

TEST(Script, RefusesFingersThatTheSceneDoesNotHave) {
    HandSpec hand = spec();
    hand.fingers = {{"pinky", {1, 0, 0}, Vec3::Zero()}};
    EXPECT_THROW(ScriptDriver(hand, {"thumb", "index"}), Error);
}

TEST(Tremor, StaysWithinItsAmplitudeAndBand) {
    const TremorSpec spec{0.1e-3, 8, 9};
    const Tremor tremor(spec, 1, 0);
    int crossings = 0;
    double most = 0;
    double last = 0;
    for (int i = 0; i < 10000; ++i) {
        FingerTarget target;
        tremor.add(target, i * 1e-3);
        most = std::max(most, std::abs(target.p_WT.x()));
        if (last * target.p_WT.x() < 0) ++crossings;
        last = target.p_WT.x();
    }
    EXPECT_NEAR(most, 0.1e-3, 1e-6);
    EXPECT_GE(crossings, 2 * 80 - 1);
    EXPECT_LE(crossings, 2 * 90 + 1);
}

TEST(Finger, StiffensWithTheForceThatItFeels) {
    Impedance impedance;
    impedance.stiffness_per_force = 60;
    Finger finger(impedance);
    const FingerTarget target{{0.01, 0, 0}, Vec3::Zero()};
    EXPECT_NEAR(finger.pull(target, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 1e-4).x(), 3.0,
                1e-12);
    Vec3 f;
    for (int i = 0; i < 10000; ++i)
        f = finger.pull(target, Vec3::Zero(), Vec3::Zero(), {0, 2, 0}, 1e-4);
    EXPECT_NEAR(f.x(), (300 + 60 * 2) * 0.01, 1e-3);
}

}  // namespace
}  // namespace dihaptic::hand::script_test
