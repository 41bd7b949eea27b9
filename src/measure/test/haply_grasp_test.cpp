// Tests the grasp benchmark with Inverse3 devices. Messages transmit numbers exactly and do not
// cost a tick, so the figures are those of the devices behind the service. However, a run begins
// with an additional message, so the hand and its tremor are one tick ahead.
#include <gtest/gtest.h>

#include <cmath>

#include "measure/grasp.h"
#include "through_haply.h"

namespace dihaptic::measure::haply_grasp_test {
namespace {

void expect_near(double a, double b) {
    EXPECT_NEAR(a, b, 1e-3 * std::abs(b) + 1e-6);
}

class HaplyGrasp : public ::testing::TestWithParam<Fingering> {};

TEST_P(HaplyGrasp, HasTheFiguresOfTheSimulatedDevices) {
    BenchSetup setup;
    setup.settings.coupling.stiffness = 1000;
    setup.fingering = GetParam();
    setup.row = Row::premium;  // with the encoder resolution and friction of the device
    const HoldFigures simulated = measure_hold(setup);
    std::unique_ptr<devices::haply::FakeService> service;
    const HoldFigures haply = measure_hold(through_haply(setup, service));
    EXPECT_TRUE(haply.held);
    expect_near(haply.lift_slip_mm, simulated.lift_slip_mm);
    expect_near(haply.slip_mm, simulated.slip_mm);
    expect_near(haply.z_rms_um, simulated.z_rms_um);
    expect_near(haply.z_pp_um, simulated.z_pp_um);
    expect_near(haply.tilt_rms_deg, simulated.tilt_rms_deg);
    expect_near(haply.turn_deg, simulated.turn_deg);
    expect_near(haply.hf_force_n, simulated.hf_force_n);
    expect_near(haply.weight_ratio, simulated.weight_ratio);
    expect_near(haply.grip_ratio, simulated.grip_ratio);
    EXPECT_GT(service->received().size(), 9000u);  // the figures came through the service
}
INSTANTIATE_TEST_SUITE_P(Bench, HaplyGrasp, ::testing::Values(Fingering::ideal, Fingering::real));

TEST(HaplyKick, MeetsAWallAsTheSimulatedDeviceDoes) {
    BenchSetup setup;
    setup.settings.coupling.stiffness = 1000;
    const KickFigures simulated = measure_kick(setup, 0.2);
    std::unique_ptr<devices::haply::FakeService> service;
    const KickFigures haply = measure_kick(through_haply(setup, service), 0.2);
    EXPECT_GT(haply.kick_ratio, 0.9);
    expect_near(haply.kick_ratio, simulated.kick_ratio);
    expect_near(haply.touch_step_n, simulated.touch_step_n);
    expect_near(haply.leave_pull_n, simulated.leave_pull_n);
}

}  // namespace
}  // namespace dihaptic::measure::haply_grasp_test
