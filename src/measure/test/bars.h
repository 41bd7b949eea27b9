// The figures that the project claims for the default coupling, as bars for each solver: for tests
// and soaks.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "measure/friction.h"
#include "measure/grasp.h"

namespace dihaptic::measure {

/// A solver's name, for tests that have it as their parameter.
inline std::string solver_name(const ::testing::TestParamInfo<dynamics::Solver>& which) {
    return std::string(enum_name(which.param));
}

/// What a finger may slip while it holds [mm]. An exact answer sticks to rounding; Bullet's
/// iterations end near it.
inline double slip_bar(dynamics::Solver solver, Fingering fingering) {
    switch (solver) {
        case dynamics::Solver::newton:
        case dynamics::Solver::staggered_projections:
            return 1e-4;
        case dynamics::Solver::stewart_trinkle:
            return 1e-3;
        case dynamics::Solver::sequential_impulse:
            return fingering == Fingering::real ? 0.004 : 0.001;
    }
    return 0;
}
/// The same during the lift [mm].
inline double lift_slip_bar(dynamics::Solver solver, Fingering fingering) {
    return solver == dynamics::Solver::sequential_impulse ? 0.01 : slip_bar(solver, fingering);
}

inline void expect_bars_of_grasp(dynamics::Solver solver) {
    BenchSetup setup;
    setup.settings.dynamics.solver = solver;
    const GraspFigures figures = bench_grasp(setup, {});
    for (const HoldFigures& h : figures.hold) {
        SCOPED_TRACE(std::string(enum_name(h.fingering)) + ", K " + std::to_string(h.k));
        EXPECT_TRUE(h.held);
        EXPECT_LE(h.lift_slip_mm, lift_slip_bar(solver, h.fingering));
        EXPECT_LE(h.slip_mm, slip_bar(solver, h.fingering));
        EXPECT_NEAR(h.weight_ratio, 1, 0.005);
        EXPECT_NEAR(h.grip_ratio, 1, 0.02);
        if (h.fingering == Fingering::ideal) {
            EXPECT_LE(h.z_pp_um, 1);
            EXPECT_LE(h.hf_force_n, 0.001);
        }
        if (h.fingering == Fingering::off_centre) {
            EXPECT_LE(h.turn_deg, 0.1);
        }
        if (h.fingering == Fingering::real) {
            EXPECT_LE(h.tilt_rms_deg, 0.05);
        }
    }
    EXPECT_GE(figures.wall_k, 5000);
    EXPECT_GE(figures.wall_k_delay, 1500);
    EXPECT_GE(figures.calm_k / figures.wall_k, 0.8);
    EXPECT_GE(figures.calm_k_delay / figures.wall_k_delay, 0.8);
    EXPECT_GE(figures.calm_k_premium, 1000);
    EXPECT_LE(figures.torque_turn_deg, 0.1);
    for (const KickFigures& kick : figures.kick) {
        SCOPED_TRACE("K " + std::to_string(kick.k) + ", " + std::to_string(kick.speed) + " m/s");
        EXPECT_LE(kick.kick_ratio, 1.03);
        EXPECT_LE(kick.touch_step_n, 0.03);
        EXPECT_LE(kick.leave_pull_n, 0.01);
    }
    EXPECT_LE(figures.drag_n, 0.01);
    for (const SlowFigures& slow : figures.slow_dynamics) {
        EXPECT_TRUE(slow.held) << slow.k;
        EXPECT_LE(slow.slip_mm, 0.01) << slow.k;
    }
}

inline void expect_bars_of_friction(dynamics::Solver solver) {
    dynamics::Settings settings;
    settings.solver = solver;
    const FrictionFigures figures = bench_friction(settings, {});
    EXPECT_LT(figures.drift_mm, 0.001);
    EXPECT_LT(std::abs(figures.accel_error), 0.001);
    EXPECT_LT(figures.direction_error_deg, 0.1);
    ASSERT_TRUE(figures.cards_drift_mm);
    EXPECT_TRUE(figures.arch_drift_mm);
    EXPECT_LT(figures.creep_mm, 0.001);
    if (solver == dynamics::Solver::sequential_impulse) {
        // improving on this is other work; losing it would be a fault
        EXPECT_LT(figures.stack_drift_mm, 10);
    } else {
        EXPECT_LE(figures.stack_drift_mm, 0.01);
        EXPECT_LE(*figures.cards_drift_mm, 0.02);
    }
}

}  // namespace dihaptic::measure
