// Tests that the torque of a stopped tool equals that of simulated devices, using fakes of the
// manufacturers' libraries that are held by the simulated hand.
#include <gtest/gtest.h>

#include "devices/test/fakes.h"
#include "servo/run.h"
#include "turning_bar.h"

namespace dihaptic::servo::makers_torque_test {
namespace {

struct Turned {
    frame::Frame last;             ///< after 1.5 s
    Vec3 acting_D = Vec3::Zero();  ///< torque that the fake's device then exerts on the hand [N*m]
    double peak = 0;               ///< peak torque stated by the device [N*m]
};

/// Turns the bar using a device of `backend`, which is either simulated or a manufacturer's.
Turned turn_the_bar(const std::string& backend, const Pose& X_WD) {
    const hand::HandSpec hand = turning_hand(0.2);
    const hand::ScriptDriver driver(hand, {"hand"});
    devices::Context context;
    context.driver = &driver;
    context.impedance = hand.impedance;
    devices::simulated::Options options;
    options.orientation = true;
    options.peak_torque = 1;
    const bool simulated = backend == "simulated";
    const Node given = parse_yaml("{orientation: yes, peak_torque_Nm: 1}", "rig.yaml");
    const std::vector<devices::DeviceConfig> configs{{"hand", X_WD, given}};
    auto group = simulated ? devices::find_backend(backend)->make(configs, context)
                           : devices::make_behind(backend, {options}, configs, context);
    Turned out;
    out.peak = group->info(0).peak_torque;
    Servo servo(turning_bar(), {}, std::move(group), {X_WD});
    servo.activate();
    const std::atomic<bool> stop{false};
    run_virtual(
        servo,
        [&](const frame::Frame& last, std::span<const frame::Handle>, frame::Commands&) {
            if (last.sequence < 0 || simulated) return;
            out.acting_D =
                backend == "openhaptics"
                    ? devices::openhaptics::fake_hd_as_it_is().devices[0].acting_torque
                    : devices::forcedimension::fake_dhd_as_it_is().devices[0].acting_torque;
        },
        [&](const frame::Frame& frame) { out.last = frame; }, std::chrono::milliseconds(1500),
        stop);
    return out;
}

class MakersTorque : public ::testing::TestWithParam<const char*> {};

TEST_P(MakersTorque, IsThatOfASimulatedDeviceWhereverItStands) {
    for (const Vec3& rotation : {Vec3(0, 0, 0), Vec3(1.2, -0.4, 2)}) {
        const Pose X_WD{rotation_xyz(rotation), Vec3::Zero()};
        const Turned expected = turn_the_bar("simulated", X_WD);
        const Turned turned = turn_the_bar(GetParam(), X_WD);
        EXPECT_EQ(turned.peak, 1);
        EXPECT_EQ(turned.last.status, 0u);
        const Vec3 t = expected.last.turns.at(0).t_sent_W;
        EXPECT_NEAR(t.y(), -0.1, 1e-3);
        EXPECT_LT((turned.last.turns.at(0).t_sent_W - t).norm(), 0.01 * t.norm());
        EXPECT_LT((X_WD.R * turned.acting_D - t).norm(), 0.01 * t.norm());
        EXPECT_LT(angle_between(turned.last.turns[0].R_WH, expected.last.turns[0].R_WH), 1e-3);
    }
}
INSTANTIATE_TEST_SUITE_P(Servo, MakersTorque, ::testing::Values("openhaptics", "forcedimension"));

}  // namespace
}  // namespace dihaptic::servo::makers_torque_test
