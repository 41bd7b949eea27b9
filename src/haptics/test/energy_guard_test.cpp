#include "haptics/energy_guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace dihaptic::haptics::energy_guard_test {
namespace {

constexpr double kTick = 1e-3;
constexpr double kStiffness = 1000;  // [N/m]

/// Does one tick along x, and returns the force that the guard adds [N].
double watch(EnergyGuard& guard, double p_H, double v_H, double p_P, double force,
             unsigned& flags) {
    const double stored = kStiffness / 2 * (p_P - p_H) * (p_P - p_H);
    return guard
        .watch({{p_H, 0, 0}, {v_H, 0, 0}}, {{}, {p_P, 0, 0}}, {{force, 0, 0}}, stored, true, kTick,
               flags)
        .force.x();
}

/// Moves a handle and a proxy along x, with the force of the coupling on the handle.
struct Motion {
    EnergyGuard guard{frame::EnergyGuardMode::warn};
    unsigned flags = 0;

    void tick(double p_H, double v_H, double p_P, double force) {
        watch(guard, p_H, v_H, p_P, force, flags);
    }
    /// Moves the handle by `depth` into a wall at x = 0 and out again, in a 20 Hz sine, for
    /// `cycles`, with damping c. Returns the sum of the squared steps inside the wall.
    double press(double c, double depth, int cycles) {
        const double w = 2 * std::numbers::pi * 20;
        double squares = 0;
        double last = 0;
        for (int i = 0; i <= 50 * cycles; ++i) {
            const double x = depth * std::sin(w * i * kTick);
            const double v = depth * w * std::cos(w * i * kTick);
            tick(x, v, std::min(x, 0.0), x > 0 ? -kStiffness * x - c * v : 0);
            if (x > 0) squares += (x - last) * (x - last);
            last = x;
        }
        return squares;
    }
};

TEST(EnergyGuard, SeesWhatTheHoldOfASampleGenerates) {
    // kStiffness / 2 times the square of each step (README.md), since no damper absorbs it
    Motion run;
    const double squares = run.press(0, 0.004, 1);
    EXPECT_NEAR(run.guard.generated(), kStiffness / 2 * squares, 0.06 * kStiffness / 2 * squares);
}

TEST(EnergyGuard, SeesThatTheDefaultDampingTakesIt) {
    Motion undamped, damped;
    undamped.press(0, 0.004, 20);
    damped.press(kStiffness * kTick / 2, 0.004, 20);
    EXPECT_GT(undamped.guard.generated(), kEnergyBudget);
    EXPECT_LT(damped.guard.generated(), 0.1 * undamped.guard.generated());
    EXPECT_EQ(damped.flags, 0u);
}

TEST(EnergyGuard, LetsAHandRestHoldAndCarry) {
    Motion run;
    for (int i = 0; i < 1000; ++i) run.tick(0.002, 0, 0, -2);  // at rest
    for (int i = 0; i < 1000; ++i) {                           // 10 cm up and down with 2 N
        const double x = 0.1 * std::sin(2 * std::numbers::pi * i * kTick);
        run.tick(x + 0.002, 0, x, -2);
    }
    EXPECT_LT(run.guard.generated(), 1e-12);
}

TEST(EnergyGuard, LetsBodiesGiveWhatTheyHave) {
    // a heavy body carries the hand along at 1 m/s against 4 N: 4 J, all supplied by the body
    Motion run;
    for (int i = 0; i < 1000; ++i) run.tick(i * kTick, 1, i * kTick + 0.004, 4);
    EXPECT_LT(run.guard.generated(), 1e-12);
}

TEST(EnergyGuard, LetsABodyBounceOffAHandAtRest) {
    Motion run;
    for (int i = 0; i <= 50; ++i) {
        const double x = -0.004 * std::sin(std::numbers::pi * i / 50);
        run.tick(0, 0, x, kStiffness * x);
    }
    EXPECT_LT(run.guard.generated(), 1e-9);
}

TEST(EnergyGuard, LetsCoulombFrictionHoldASpringThatWasStretched) {
    // the proxy sticks while the handle moves 2 mm away, then slides along behind it, and back
    Motion run;
    double p_P = 0;
    for (int i = 0; i < 4000; ++i) {
        const double x = 0.02 * std::sin(2 * std::numbers::pi * i * kTick / 2);
        const double v = 0.02 * std::numbers::pi * std::cos(2 * std::numbers::pi * i * kTick / 2);
        p_P = std::clamp(p_P, x - 0.002, x + 0.002);
        run.tick(x, v, p_P, kStiffness * (p_P - x) - kStiffness * kTick / 2 * v);
    }
    EXPECT_LT(run.guard.generated(), kEnergyBudget / 10);
    EXPECT_EQ(run.flags, 0u);
}

TEST(EnergyGuard, LetsAHandStrainAtWhatItDrivesAlong) {
    // the proxy slides at 1 m/s, the hand follows at 2 m/s: friction absorbs the stronger push a
    // tick before the hand feels it (20 mJ in 20 ticks) and keeps that energy
    const auto strain = [](Motion& run, double c) {
        for (int i = 0; i <= 20; ++i) {
            const double stretch = -1.0 * kTick * i;
            run.tick(2 * kTick * i, 2, kTick * i, kStiffness * stretch - c);
        }
    };
    Motion damped, negative;
    strain(damped, kStiffness * kTick / 2);
    EXPECT_LT(damped.guard.generated(), kEnergyBudget / 10);
    strain(negative, -1);
    EXPECT_NE(negative.flags & kEnergyGenerated, 0u);
}

TEST(EnergyGuard, LetsASpringThatCameFreeCatchAgainWithWhatItKept) {
    // a wedged proxy with a stretch of 150 mm slips out, and is caught again before its spring is
    // relaxed; the hand is still pushed in that tick
    Motion run;
    for (int i = 0; i < 10; ++i) run.tick(0, 0, 0.15, 170);
    run.tick(0.001, 0, 0.15, 0);
    run.tick(0.001, 0, 0.09, 0);
    for (int i = 0; i < 3; ++i) run.tick(0.001, 0, 0.04, 39);
    EXPECT_LT(run.guard.generated(), 1e-12);
    EXPECT_EQ(run.flags, 0u);
    // the spring must not return energy that it did not store: it relaxes, and is then stretched
    // again without any work
    run.tick(0.001, 0, 0.001, 0);
    run.tick(0.021, 0, 0.001, 0);
    for (int i = 0; i < 3; ++i) run.tick(0.021, 0, 0.001, -20);
    EXPECT_GT(run.guard.generated(), 0.9 * kStiffness / 2 * 0.02 * 0.02);
    EXPECT_NE(run.flags & kEnergyGenerated, 0u);
}

TEST(EnergyGuard, LetsABodyHitARestingProxy) {
    Motion run;
    for (int i = 0; i < 10; ++i) run.tick(0, 0, 0, 0);
    const double c = kStiffness * kTick / 2;
    for (int i = 0; i < 3; ++i) run.tick(0, 0, 0.005, 5 + c * (i == 0 ? 5 : 0));
    EXPECT_LT(run.guard.generated(), 1e-12);
}

TEST(EnergyGuard, IsNotLulledByWhatWasDissipatedBefore) {
    // 5 N*s/m absorb energy for a second, then the same negative damping releases it. With v the
    // mean square speed while in contact, which is half of the time, the energy is c v / 2 per
    // second.
    Motion run;
    const double depth = 0.002;
    run.press(5, depth, 20);
    ASSERT_LT(run.guard.generated(), 1e-3);
    const double speed = depth * 2 * std::numbers::pi * 20;
    const double power = 5 * speed * speed / 2 / 2;
    const int cycles = static_cast<int>(2 * kEnergyBudget / power / 0.05) + 1;
    run.press(-5, depth, cycles);
    EXPECT_NE(run.flags & kEnergyGenerated, 0u) << cycles;
    EXPECT_LT(cycles, 10);
    EXPECT_EQ(run.flags & kEnergyDamped, 0u);  // since the mode is 'warn'
}

TEST(EnergyGuard, ActsAgainstTheMotionAndNoMoreThanItNeeds) {
    EnergyGuard guard(frame::EnergyGuardMode::act);
    unsigned flags = 0;
    // an unexplained push of 5 N while the proxy and the wall stand still
    watch(guard, 0, 0.5, 0.005, 5, flags);
    double damper = 0;
    double x = 0;
    for (int i = 0; i < 40 && flags == 0; ++i) {
        x += 0.5 * kTick;
        damper = watch(guard, x, 0.5, x + 0.005, 5, flags);
    }
    EXPECT_EQ(flags, 0u) << "a body pushed";
    for (int i = 0; i < 40 && flags == 0; ++i) {
        x += 0.5 * kTick;
        // the force stays the same even though the spring relaxes
        damper = watch(guard, x, 0.5, 0.025, 5, flags);
    }
    EXPECT_EQ(flags, unsigned{kEnergyGenerated} | kEnergyDamped);
    EXPECT_LT(damper, 0);
    EXPECT_GE(damper, -kMostEnergyDamping * 0.5);
    const double excess = guard.generated() - kEnergyBudget;
    EXPECT_LE(-damper * 0.5 * kTick, excess * (1 + 1e-9));
}

TEST(EnergyGuard, CanBeOff) {
    Motion run;
    run.guard = EnergyGuard(frame::EnergyGuardMode::off);
    run.press(-5, 0.004, 20);
    EXPECT_EQ(run.flags, 0u);
    EXPECT_EQ(run.guard.generated(), 0);
}

}  // namespace
}  // namespace dihaptic::haptics::energy_guard_test
