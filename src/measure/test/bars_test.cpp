// The figures that the project claims for the default coupling and Bullet's solver, as bars.
#include <gtest/gtest.h>

#include "measure/friction.h"
#include "measure/grasp.h"

namespace dihaptic::measure {
namespace {

TEST(BenchGrasp, ReachesItsBars) {
    const GraspFigures figures = bench_grasp({}, {});
    for (const HoldFigures& h : figures.hold) {
        SCOPED_TRACE(std::string(enum_name(h.fingering)) + ", K " + std::to_string(h.k));
        EXPECT_TRUE(h.held);
        EXPECT_LE(h.lift_slip_mm, 0.01);
        EXPECT_LE(h.slip_mm, h.fingering == Fingering::real ? 0.004 : 0.001);
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

TEST(BenchGrasp, ShowsTheFaultsOfTheDualSpring) {
    BenchSetup setup;
    setup.settings.coupling.kind = haptics::CouplingKind::dual_spring;
    setup.settings.coupling.stiffness = 1000;
    EXPECT_GT(measure_kick(setup, 0.5).kick_ratio, 1.1);
    EXPECT_GT(measure_kick(setup, 0.5).leave_pull_n, 0.02);
    EXPECT_GT(measure_drag(setup), 0.002);
    EXPECT_FALSE(calm_grasp(measure_hold(setup)));
}

TEST(BenchGrasp, SeesWhatIsNotHeld) {
    BenchSetup setup;
    setup.settings.coupling.stiffness = 1000;
    setup.friction = 0.1;  // needs 4.9 N of grip, has 3.5
    EXPECT_FALSE(measure_hold(setup).held);
}

TEST(BenchFriction, ReachesWhatItReached) {
    // improving on these is other work; losing them would be a fault
    const FrictionFigures figures = bench_friction({}, {});
    EXPECT_LT(figures.drift_mm, 0.001);
    EXPECT_LT(std::abs(figures.accel_error), 0.001);
    EXPECT_LT(figures.direction_error_deg, 0.1);
    EXPECT_LT(figures.stack_drift_mm, 10);
    EXPECT_TRUE(figures.cards_drift_mm);
    EXPECT_TRUE(figures.arch_drift_mm);
    EXPECT_LT(figures.creep_mm, 0.001);
}

}  // namespace
}  // namespace dihaptic::measure
