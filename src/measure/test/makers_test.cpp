// Tests that bench grasp gives the same figures through fakes of the manufacturers' libraries as
// with the simulated devices themselves.
#include "measure/test/makers.h"

namespace dihaptic::measure::makers_test {
namespace {

class Makers : public ::testing::TestWithParam<std::string> {
  protected:
    BenchSetup simulated;
    BenchSetup made;
    Makers() {
        simulated.row = Row::premium;  // the encoder resolution and friction of the Premium
        made = by_maker(simulated, GetParam());
    }
    void set(double k, Fingering fingering) {
        simulated.settings.coupling.stiffness = made.settings.coupling.stiffness = k;
        simulated.fingering = made.fingering = fingering;
    }
};
INSTANTIATE_TEST_SUITE_P(Backends, Makers, ::testing::Values("openhaptics", "forcedimension"),
                         [](const auto& instance) { return instance.param; });

TEST_P(Makers, HoldAndLiftAreTheSame) {
    for (const double k : {300.0, 500.0, 1000.0, 2000.0}) {
        set(k, Fingering::real);
        const HoldFigures a = measure_hold(simulated);
        const HoldFigures b = measure_hold(made);
        EXPECT_TRUE(a.held);
        EXPECT_TRUE(b.held);
        expect_alike(a.weight_ratio, b.weight_ratio, 0);
        expect_alike(a.grip_ratio, b.grip_ratio, 0);
        expect_alike(a.slip_mm, b.slip_mm, 1e-5);
        expect_alike(a.lift_slip_mm, b.lift_slip_mm, 1e-5);
        // The block trembles by a tenth of a millimetre and, with a stiff coupling, never twice in
        // the same way: at 2000 N/m these figures of one maker's hold vary by 15 % if the solver
        // ends a tenth earlier, and at 1000 N/m by 5 % if it changes the twelfth digit.
        const double share = k > 1000 ? 0.3 : k > 500 ? 0.1 : 0.01;
        expect_alike(a.z_rms_um, b.z_rms_um, 1e-2, share);
        expect_alike(a.z_pp_um, b.z_pp_um, 1e-2, share);
        expect_alike(a.tilt_rms_deg, b.tilt_rms_deg, 1e-4, share);
        expect_alike(a.turn_deg, b.turn_deg, 1e-4, share);
        expect_alike(a.hf_force_n, b.hf_force_n, 1e-4, share);
    }
}

TEST_P(Makers, TouchingAWallIsTheSame) {
    set(1000, Fingering::ideal);
    const KickFigures a = measure_kick(simulated, 0.5);
    const KickFigures b = measure_kick(made, 0.5);
    EXPECT_GT(a.kick_ratio, 0.5);
    expect_alike(a.kick_ratio, b.kick_ratio, 0);
    expect_alike(a.touch_step_n, b.touch_step_n, 1e-4);
    expect_alike(a.leave_pull_n, b.leave_pull_n, 1e-4);
    expect_alike(measure_drag(simulated), measure_drag(made), 1e-4);
}

TEST_P(Makers, ATorqueTurnsTheBlockTheSame) {
    set(1000, Fingering::ideal);
    const auto a = measure_torque(simulated);
    const auto b = measure_torque(made);
    EXPECT_GT(a.first, 0);
    expect_alike(a.first, b.first, 1e-4);
    expect_alike(a.second, b.second, 1e-4);
}

TEST_P(Makers, RunsAreTheSameToTheBit) {
    set(1000, Fingering::real);
    const HoldFigures a = measure_hold(made);
    const HoldFigures b = measure_hold(made);
    EXPECT_EQ(a.weight_ratio, b.weight_ratio);
    EXPECT_EQ(a.z_rms_um, b.z_rms_um);
    EXPECT_EQ(a.hf_force_n, b.hf_force_n);
}

}  // namespace
}  // namespace dihaptic::measure::makers_test
