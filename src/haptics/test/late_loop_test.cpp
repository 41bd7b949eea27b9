#include "haptics/late_loop.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace dihaptic::haptics::late_loop_test {
namespace {

/// Whether a handle of 75 g comes to rest after a push of 1 mm, in a loop with one tick every T
/// seconds. The hand has the stiffness k_h and the damping b_h, and presses with 1.5 N on a wall
/// with stiffness k and a damper k h / 2.
bool comes_to_rest(double k, double T, double k_h, double b_h) {
    constexpr double kTick = 1e-3;
    constexpr double kStep = 1e-4;
    constexpr double kMass = 0.075;
    constexpr double kPress = 1.5;
    const double target = kPress / k_h + kPress / k;
    double x = kPress / k + 1e-3;
    double v = 0;
    double least = 10;
    double most = 0;
    for (int tick = 0; tick * T < 3; ++tick) {
        const double force = x > 0 ? std::max(0.0, k * x + k * kTick / 2 * v) : 0;
        if (tick * T > 2) {
            least = std::min(least, force);
            most = std::max(most, force);
        }
        for (int i = 0; i < std::lround(T / kStep); ++i) {
            v += kStep / kMass * (k_h * (target - x) - b_h * v - std::min(force, 8.5));
            x += kStep * v;
        }
    }
    return most - least < 0.02;
}

double stiffest(double T, double k_h, double b_h) {
    double calm = 10;
    double shaking = 20000;
    while (shaking > 1.01 * calm) {
        const double k = std::sqrt(calm * shaking);
        (comes_to_rest(k, T, k_h, b_h) ? calm : shaking) = k;
    }
    return calm;
}

TEST(LateLoop, HoldsWhatIsSaid) {
    fmt::print("late by  hand       said, N/m  shakes above  2 b / T\n");
    for (const int by : {2, 5, 10, 20, 38}) {
        for (const double share : {1 / 3.0, 1.0, 3.0}) {
            const double T = (by + 1) * 1e-3;
            const double b = 3 * share;
            const double said = held_stiffness(b, by * 1e-3);
            const double limit = stiffest(T, 300 * share, b);
            fmt::print("{:4d} ms  {:3g} N*s/m  {:9.0f}  {:12.0f}  {:7.0f}\n", by, b, said, limit,
                       model::passive_stiffness(b, T));
            EXPECT_LE(said, limit) << by << " ms, " << b;
            EXPECT_GE(said, limit / 2.6) << by << " ms, " << b;
        }
    }
}

TEST(LateLoop, ThatIsInTimeHoldsAnythingAndSoftensNothing) {
    EXPECT_EQ(held_stiffness(1, 0), std::numeric_limits<double>::infinity());
    frame::CouplingSettings settings;
    settings.stiffness = 1e6;
    settings.damping = 1e3;
    settings.turn_damping = 1e3;
    const frame::CouplingSettings same = softened(settings, 1, 0, 1e-3);
    EXPECT_EQ(same, settings);
}

TEST(LateLoop, SoftensOnceAsTwice) {
    frame::CouplingSettings settings;
    settings.damping = 8;
    settings.turn_damping = 0.1;
    settings.turn_stiffness = 5;
    const frame::CouplingSettings once = softened(settings, 3, 20e-3, 1e-3);
    EXPECT_DOUBLE_EQ(once.stiffness, 0.7 * 2 * 3 / 20e-3);
    EXPECT_DOUBLE_EQ(once.turn_stiffness, 0.7 * 2 * 0.02 / 20e-3);
    // m / L
    EXPECT_DOUBLE_EQ(*once.damping, 0.075 / 20e-3);
    EXPECT_DOUBLE_EQ(*once.turn_damping, 1e-4 / 20e-3);
    EXPECT_DOUBLE_EQ(once.smoothing, 20.0 / 21);
    const frame::CouplingSettings twice = softened(once, 3, 20e-3, 1e-3);
    EXPECT_EQ(twice, once);
    settings = {};
    settings.stiffness = 50;
    EXPECT_EQ(softened(settings, 3, 20e-3, 1e-3).stiffness, 50);
    EXPECT_FALSE(softened(settings, 3, 20e-3, 1e-3).damping);
}

TEST(BoundRise, FollowsTheSpringThatIsHeldAndFallsFreely) {
    const Vec3 last(-2, 0, 0);
    const double k = 200;
    // the handle moves 1 mm deeper along x, against a force along -x
    const Vec3 deeper(1e-3, 0, 0);
    const auto bounded = [&](double asked) {
        return bound_rise({-asked, 0, 0}, last, deeper, k, 0.01).x();
    };
    EXPECT_DOUBLE_EQ(bounded(9), -(2 + 0.2 + 0.01));
    EXPECT_EQ(bounded(2.1), -2.1);
    EXPECT_EQ(bounded(0.3), -0.3);
    EXPECT_EQ(bound_rise(Vec3::Zero(), last, deeper, k, 0.01), Vec3::Zero());
    // on the way out, the bound falls like the force of the same spring, so it releases no more
    // energy than it absorbed
    EXPECT_DOUBLE_EQ(bound_rise({-9, 0, 0}, last, -deeper, k, 0.01).x(), -(2 - 0.2 + 0.01));
    EXPECT_DOUBLE_EQ(bound_rise({-9, 0, 0}, last, -50 * deeper, k, 0.01).x(), -0.01);
}

TEST(BoundRise, IsForTheWayInWhichTheForceActs) {
    // a force in the opposite direction, or across it, is not a valid start
    EXPECT_DOUBLE_EQ(bound_rise({3, 0, 0}, {-2, 0, 0}, Vec3::Zero(), 200, 0.01).x(), 0.01);
    EXPECT_DOUBLE_EQ(bound_rise({0, 3, 0}, {-2, 0, 0}, {0, -1e-3, 0}, 200, 0.01).y(), 0.21);
    const Vec3 turned = bound_rise({0, 2, 2}, {0, 2, 0}, Vec3::Zero(), 200, 0);
    EXPECT_NEAR((turned - Vec3(0, 1, 1)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace dihaptic::haptics::late_loop_test
