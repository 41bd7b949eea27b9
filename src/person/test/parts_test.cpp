// Tests the eyes, strokes and memories of a simulated person separately.
#include <gtest/gtest.h>

#include <numbers>

#include "person/eyes.h"
#include "person/gain_memory.h"
#include "person/grip_memory.h"
#include "person/rotation_memory.h"
#include "person/strokes.h"

namespace dihaptic::person::parts_test {
namespace {

TEST(Eyes, SeeWhereThingsAreShownAWhileAgo) {
    Eyes eyes(0.1, 0, 2, 1e-3);
    frame::Frame frame;
    frame.fingers.resize(2);
    frame.task.reserve({1});
    frame::VisualMap map;
    map.moves = frame::kMovesProxies;
    map.scale = Vec3(2, 1, 1);
    frame.task.visual.push_back(map);
    frame.task.targets.push_back({3, Vec3(0, 0, 1), 0.01});
    for (int i = 0; i <= 500; ++i) {
        frame.trial = i;
        frame.fingers[0].p_WP = Vec3(i * 1e-3, 0, 0);
        frame.fingers[1].p_WP = Vec3(i * 1e-3, 2, 0);
        eyes.take(frame);
        EXPECT_EQ(eyes.sight().trial, std::max(0, i - 100));
    }
    EXPECT_NEAR(eyes.sight().hand.x(), 2 * 0.4, 1e-12);  // the displayed position, not the true one
    EXPECT_TRUE(eyes.sight().hand_shown);
    EXPECT_NEAR(eyes.sight().hand.y(), 1, 1e-12);
    EXPECT_EQ(eyes.sight().shown, 1u << 3);
    EXPECT_EQ(eyes.sight().target[3], Vec3(0, 0, 1));
    frame.task.looks = {{0, 1, -1, 1}};
    for (int i = 0; i <= 100; ++i) eyes.take(frame);
    EXPECT_TRUE(eyes.sight().hand_shown);  // the other finger is displayed
    frame.task.looks.push_back({1, 1, -1, 1});
    for (int i = 0; i <= 100; ++i) eyes.take(frame);
    EXPECT_FALSE(eyes.sight().hand_shown);
}

TEST(Strokes, AddUpAndEndWhereTheyLead) {
    Strokes strokes;
    strokes.rest({Vec3(0, 0, 1), 0.1, 0});
    strokes.add({Vec3(1, 0, 0), 0, 0}, 0, 1);
    strokes.add({Vec3(0, 1, 0), -0.05, 2}, 0.5, 0.5, 0.2);
    EXPECT_DOUBLE_EQ(strokes.end(), 1.2);
    EXPECT_NEAR(strokes.at(0.5).centre.x(), 0.5, 1e-12);
    EXPECT_NEAR(strokes.at(0.5).centre.y(), 0, 1e-12);
    EXPECT_NEAR(strokes.at(2).centre.y(), 1, 1e-12);
    EXPECT_NEAR(strokes.at(2).aperture, 0.05, 1e-12);
    EXPECT_NEAR(strokes.at(2).load, 2, 1e-12);
    EXPECT_EQ(strokes.goal().centre, Vec3(1, 1, 1));
    for (double t = 0.05; t < 1.3; t += 0.05) {
        const double h = 1e-5;
        const Aim before = strokes.at(t - h);
        const Aim now = strokes.at(t);
        const Aim after = strokes.at(t + h);
        EXPECT_LT((strokes.rate(t).centre - (after.centre - before.centre) / (2 * h)).norm(), 1e-6);
        const Vec3 second = (after.centre - 2 * now.centre + before.centre) / (h * h);
        EXPECT_LT((strokes.acceleration(t) - second).norm(), 1e-3);
    }
}

TEST(Strokes, KeepTheirPlaceHoweverManyThereAre) {
    Strokes strokes;
    for (int i = 0; i < 100; ++i) strokes.add({Vec3(1, 0, 0), 0, 0}, i, 0.5);
    EXPECT_NEAR(strokes.at(200).centre.x(), 100, 1e-9);
    EXPECT_NEAR(strokes.at(99).centre.x(), 99, 1e-9);
}

TEST(RotationMemory, IsTheTwoRateModelForOneTarget) {
    const model::TwoRate rates = model::kSmith2006;
    RotationMemory memory(rates, 0.6, {});
    model::TwoRateState state;
    const Vec3 d = Vec3(0, 1, 0);
    for (int n = 0; n < 200; ++n) {
        const double f = n < 100 ? 0.5 : n < 150 ? -0.5 : 0;
        EXPECT_NEAR(memory.expected(d).z(), state.output(), 1e-12);
        const double error = n < 150 ? f - state.output() : 0;
        memory.learn(d, error * Vec3::UnitZ());
        state = next(rates, state, error);
    }
}

TEST(RotationMemory, LearnsHardlyMoreFromErrorsAboveItsLimits) {
    const ErrorLimits limits{0.35, 0.12};
    const auto learned = [&](double error) {
        RotationMemory memory({{0.6, 0.5}, {0.99, 0.1}}, 0.6, limits);
        memory.learn(Vec3::UnitY(), Vec3(0, 0, error));
        return memory.expected(Vec3::UnitY()).z();
    };
    EXPECT_NEAR(learned(1e-3), (0.5 + 0.1) * 1e-3, 1e-8);
    EXPECT_NEAR(learned(0.5),
                0.5 * 0.35 * std::tanh(0.5 / 0.35) + 0.1 * 0.12 * std::tanh(0.5 / 0.12), 1e-12);
    EXPECT_NEAR(learned(-3), -(0.5 * 0.35 + 0.1 * 0.12), 1e-7);
}

TEST(RotationMemory, GeneralisesWhatIsSlowByAGaussianOfDirections) {
    const double width = 0.6;
    RotationMemory memory({{0.6, 0}, {0.99, 0.03}}, width, {});
    const auto direction = [](double angle) { return Vec3(std::sin(angle), std::cos(angle), 0); };
    for (int n = 0; n < 50; ++n) memory.learn(direction(0), Vec3(0, 0, 0.1));
    const double here = memory.expected(direction(0)).z();
    EXPECT_NEAR(memory.expected(direction(width)).z(), std::exp(-0.5) * here, 1e-9);
    EXPECT_NEAR(memory.expected(direction(-2 * width)).z(), std::exp(-2.0) * here, 1e-9);
    EXPECT_LT(memory.expected(direction(std::numbers::pi)).z(), 1e-5);
    // there are more directions than can be stored, but nothing learned must get lost
    for (int n = 0; n < 500; ++n) memory.learn(direction(0.1 * n), Vec3(0, 0, 0.1));
    EXPECT_TRUE(std::isfinite(memory.expected(direction(1)).z()));
    EXPECT_GT(memory.expected(direction(1)).z(), 0);
}

TEST(GainMemory, IsTheSingleRateModelForOneDirectionAndOfAnotherOnlyAsFarAsTheyShareAxes) {
    const model::SingleRate rate{0.98, 0.25};
    const Vec3 d = Vec3(2, 1, 0).normalized();
    GainMemory memory(rate);
    double x = 0;
    for (int n = 0; n < 60; ++n) {
        EXPECT_NEAR(memory.expected(d), x, 1e-12);
        EXPECT_NEAR(memory.expected(-d), x, 1e-12);
        const double error = std::log(1.4) - memory.expected(d);  // shown 1.4 times as long
        memory.learn(d, error);
        x = next(rate, x, std::log(1.4) - x);
    }
    EXPECT_NEAR(x, std::log(1.4) * asymptote(rate), 1e-3);
    EXPECT_EQ(memory.expected(Vec3::UnitZ()), 0);
    EXPECT_GT(memory.expected(Vec3::UnitX()), memory.expected(Vec3::UnitY()));
}

TEST(GripMemory, LearnsAMassAlongTheAxisThatItWasCarried) {
    GripMemory memory;
    memory.weight = 0.981;  // 0.1 kg
    const model::SingleRate rate{0.97, 0.25};
    double x = 0;
    for (int n = 0; n < 30; ++n) {
        EXPECT_NEAR(memory.more_mass.x(), x, 1e-12);
        memory.carried(Vec3::UnitX(), 0.3, rate);
        x = next(rate, x, 0.2 - x);
    }
    EXPECT_NEAR(memory.more_mass.x(), 0.2 * asymptote(rate), 1e-3);
    EXPECT_EQ(memory.more_mass.y(), 0);
    EXPECT_NEAR(memory.inertial(Vec3(1, 1, 0)).y(), 0.1, 1e-12);
    memory.lifted(1.981, 0.5);
    EXPECT_NEAR(memory.weight, 1.481, 1e-12);
}

}  // namespace
}  // namespace dihaptic::person::parts_test
