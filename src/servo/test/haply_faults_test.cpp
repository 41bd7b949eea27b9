// Tests a grasp with two Inverse3 devices whose service fails during the grasp, on the real clock.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "devices/haply/test/fake_service.h"
#include "lift.h"
#include "servo/run.h"

namespace dihaptic::servo::haply_faults_test {
namespace {

using devices::haply::FakeService;
using devices::haply::Mischief;
using std::chrono::milliseconds;

constexpr int kMessage = 150;  // the fingers have closed by then
constexpr int kAfter = 30;     // number of ticks to check after a fault

struct Case {
    Mischief what;
    haptics::FaultKind kind;
    double time_out_ms = 100;
    int late_ms = 0;
};

/// The outcome of one run.
struct Outcome {
    int mischief_tick = -1;  ///< tick in which the service failed; -1 if the run ended earlier
    std::vector<FakeService::Forces> felt;
    haptics::Fault fault;
    int after_fault = 0;  ///< number of Frames since the fault
    bool force_after_fault = false;
};

Outcome grasp(const Case& c) {
    const scene::Scene scene = block_on_table();
    hand::HandSpec hand = lifting_hand();
    hand.script.front().duration = 0.1;  // kept short to avoid disturbances
    const auto fingers = scene::finger_names(scene);
    const hand::ScriptDriver driver(hand, fingers);
    devices::Context context;
    context.driver = &driver;
    context.impedance = hand.impedance;
    FakeService::Setup setup;
    setup.rate = 1000;
    for (const std::string& finger : fingers) setup.devices.push_back({finger, {}, {}});
    FakeService service(setup, context);
    service.misbehave(c.what, kMessage, 1, milliseconds(c.late_ms));

    frame::Settings settings;
    settings.safety.max_pause = 1;  // pauses of a busy machine are not the subject of this test
    settings.safety.hand_damping = 100;
    settings.safety.soft_start = 0;
    const auto configs =
        rig_of(service, setup.devices, fmt::format("time_out_ms: {}, ", c.time_out_ms));
    Servo servo(scene, settings, devices::find_backend("haply")->make(configs, context),
                std::vector<Pose>(2));
    servo.activate();
    Outcome out;
    const frame::Director director = [&](const frame::Frame&, std::span<const frame::Handle>,
                                         frame::Commands& commands) {
        commands.stop = out.after_fault >= kAfter;
    };
    const frame::FrameSink sink = [&](const frame::Frame& frame) {
        if (!servo.fault()) return;
        ++out.after_fault;
        for (const frame::FingerFrame& finger : frame.fingers)
            out.force_after_fault = out.force_after_fault || finger.f_sent_W != Vec3::Zero();
    };
    const std::atomic<bool> stop{false};
    Timing timing;
    run_real(servo, director, sink, Time(0), std::chrono::seconds(20), stop, timing);
    servo.deactivate();
    out.fault = servo.fault();
    out.mischief_tick = service.mischief_tick();
    out.felt = service.felt();
    return out;
}

class HaplyFault : public ::testing::TestWithParam<Case> {};

TEST_P(HaplyFault, LeavesNoForceOnAnyDeviceAndEndsNothingElse) {
    Outcome result;
    // on a busy machine, a real pause may come first and end the run
    for (int attempt = 0; attempt < 20 && result.mischief_tick < 0; ++attempt)
        result = grasp(GetParam());
    if (result.mischief_tick < 0)
        GTEST_SKIP() << "the machine pauses too often for a time-out of " << GetParam().time_out_ms
                     << " ms";
    EXPECT_EQ(result.fault.kind, GetParam().kind);
    EXPECT_GE(result.after_fault, kAfter);
    EXPECT_FALSE(result.force_after_fault);
    const auto mischief = static_cast<size_t>(result.mischief_tick);
    for (size_t device = 0; device < 2; ++device) {
        double before = 0;
        for (size_t tick = mischief - 20; tick <= mischief; ++tick)
            before = std::max(before, result.felt[tick][device].norm());
        EXPECT_GT(before, 0.5) << device;
        ASSERT_GT(result.felt.size(), mischief + 2);
        for (size_t tick = mischief + 2; tick < result.felt.size(); ++tick)
            ASSERT_EQ(result.felt[tick][device], Vec3::Zero()) << device << " " << tick - mischief;
    }
}
INSTANTIATE_TEST_SUITE_P(
    Servo, HaplyFault,
    ::testing::Values(Case{Mischief::late, haptics::FaultKind::not_answering, 4, 5},
                      Case{Mischief::late, haptics::FaultKind::not_answering, 20, 50},
                      Case{Mischief::silent, haptics::FaultKind::not_answering},
                      Case{Mischief::half_message, haptics::FaultKind::not_answering},
                      Case{Mischief::half_json, haptics::FaultKind::not_answering},
                      Case{Mischief::not_a_number, haptics::FaultKind::bad_reading},
                      Case{Mischief::leaves_out, haptics::FaultKind::not_answering},
                      Case{Mischief::loses_calibration, haptics::FaultKind::not_answering},
                      Case{Mischief::complains, haptics::FaultKind::not_answering},
                      Case{Mischief::closes, haptics::FaultKind::not_answering}));

}  // namespace
}  // namespace dihaptic::servo::haply_faults_test
