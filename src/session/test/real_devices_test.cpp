// Tests sessions with fakes of real devices, in real time.
#include <gtest/gtest.h>

#include <filesystem>

#include "devices/forcedimension/dhd.h"
#include "devices/openhaptics/hd.h"
#include "devices/test/fakes.h"
#include "session/check.h"
#include "session/record.h"
#include "session/replay.h"
#include "testing/files.h"

namespace dihaptic::session::real_devices_test {
namespace {

std::string rig_text(const std::string& backend) {
    const bool hd = backend == "openhaptics";
    const std::string library = hd ? DIHAPTIC_FAKE_HD : DIHAPTIC_FAKE_DHD;
    std::string out = "devices:\n";
    for (const int i : {1, 2}) {
        const std::string which =
            hd ? fmt::format("name: PHANToM {}", i) : fmt::format("serial: {}", 100 + i);
        out += fmt::format("  - {{finger: {}, backend: {}, options: {{library: {}, {}}}}}\n",
                           i == 1 ? "thumb" : "index", backend, library, which);
    }
    // long pauses are allowed, because busy machines are the subject of another test
    return out + "settings: { safety: { max_pause_ms: 1000, hand_damping_Ns_m: 100 } }\n";
}

class RealDevices : public ::testing::TestWithParam<const char*> {
  protected:
    testing::TemporaryFolder folder;
    Request request;
    RealDevices() {
        if (hd()) devices::openhaptics::fake_hd().real_time = true;
        if (!hd()) devices::forcedimension::fake_dhd();
        request.file = "scenes/block-on-table.yaml";
        request.rig = folder.write("rig.yaml", rig_text(GetParam()));
    }
    bool hd() const { return std::string(GetParam()) == "openhaptics"; }
    /// Returns how often each device was opened.
    std::vector<int> opened() const {
        std::vector<int> out;
        for (const size_t i : {0, 1}) {
            out.push_back(hd() ? devices::openhaptics::fake_hd_as_it_is().devices[i].opened
                               : devices::forcedimension::fake_dhd_as_it_is().devices[i].opened);
        }
        return out;
    }
};
INSTANTIATE_TEST_SUITE_P(Backends, RealDevices, ::testing::Values("openhaptics", "forcedimension"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST_P(RealDevices, NeedNoSimulatedHand) {
    EXPECT_TRUE(on_real_devices(request));
    const Plan plan = make_plan(request);
    EXPECT_TRUE(plan.open_ended());
    EXPECT_EQ(plan.seeing, nullptr);
    ASSERT_EQ(plan.driver->phases().size(), 1u);
    EXPECT_EQ(plan.driver->duration(), hand::kLongestScript);
    request.file = "experiments/visuomotor-rotation.yaml";
    request.participant = "S07";
    if (hd()) request.set.emplace_back("rate_Hz=1000");
    const Plan trials = make_plan(request);
    EXPECT_FALSE(trials.open_ended());
    EXPECT_EQ(trials.seeing, nullptr);
    EXPECT_NE(trials.task, nullptr);
}

TEST_P(RealDevices, AreOpenedOnceByTheirSessionAndByNothingBeforeIt) {
    Plan plan = make_plan(request);
    Diagnostics diagnostics;
    check_file(request.file, diagnostics, request.rig);
    check_file(request.rig, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors());
    EXPECT_TRUE(std::isinf(plan.devices[1].peak_force));
    EXPECT_EQ(opened(), (std::vector{0, 0}));

    auto devices = open_devices(plan);
    EXPECT_EQ(plan.devices, devices->descriptions());
    EXPECT_TRUE(std::isfinite(plan.devices[1].peak_force));
    EXPECT_EQ(opened(), (std::vector{1, 1}));
    EXPECT_FALSE(devices->active());

    RunOptions options;
    options.out = folder.path();
    options.clock = Clock::real;
    const std::atomic<bool> stop{true};
    const RunResult result = run_session(plan, options, stop, {}, std::move(devices));
    EXPECT_EQ(opened(), (std::vector{1, 1}));
    EXPECT_EQ(static_cast<const frame::DeviceInfo&>(result.info.devices[1]), plan.devices[1]);
}

TEST_P(RealDevices, ThatAreNotThereAreMissedWhenTheyAreOpened) {
    request.rig = folder.write(
        "none.yaml",
        "devices:\n  - {finger: thumb, backend: forcedimension, options: {library: /no/such.so, "
        "serial: 1}}\n  - {finger: index, backend: forcedimension, options: {library: "
        "/no/such.so, serial: 2}}\n");
    Plan plan = make_plan(request);
    EXPECT_THROW(open_devices(plan), Error);
}

TEST_P(RealDevices, SayOnceTheyAreOpenWhatSharesAndLimitsAreOf) {
    std::string rig = rig_text(GetParam());
    rig.replace(rig.find("max_pause_ms"), 0, "max_force_N: 20, ");
    request.rig = folder.write("strong.yaml", rig);
    Plan plan = make_plan(request);
    const size_t before = plan.warnings.size();
    open_devices(plan);
    ASSERT_EQ(plan.warnings.size(), before + 1);
    EXPECT_NE(plan.warnings.back().text().find("20 N is more than "), std::string::npos);

    request.set.emplace_back("coupling.stiffness_share=0.5");
    plan = make_plan(request);
    EXPECT_TRUE(plan.settings.coupling.stiffness_share);
    if (hd()) {
        open_devices(plan);
        EXPECT_FALSE(plan.settings.coupling.stiffness_share);
        EXPECT_DOUBLE_EQ(plan.settings.coupling.stiffness, 500);
    } else {
        EXPECT_THROW(open_devices(plan), Error);
    }
}

TEST_P(RealDevices, StandInsAreToldOf) {
    request.simulate = true;
    EXPECT_FALSE(on_real_devices(request));
    const Plan plan = make_plan(request);
    ASSERT_FALSE(plan.warnings.empty());
    EXPECT_NE(plan.warnings[0].text().find("are not simulated: ideal devices replace them"),
              std::string::npos);
}

TEST_P(RealDevices, KeepRealTimeAndNobodyMovesThemByARecording) {
    RunOptions options;
    options.out = folder.path();
    const std::atomic<bool> stop{false};
    EXPECT_THROW(run_session(make_plan(request), options, stop, {}), Error);
    request.file = "experiments/reach-to-grasp.yaml";
    try {
        make_plan(request);
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(
            std::string(e.what()).find(
                "moves simulated fingers, but this rig's devices are real. Choose another rig"),
            std::string::npos)
            << e.what();
    }
}

TEST_P(RealDevices, ThatRefuseToStartLeaveNoSession) {
    const Plan plan = make_plan(request);
    if (hd())
        devices::openhaptics::fake_hd_as_it_is().devices[1].calibration =
            devices::openhaptics::kHdNeedsUpdate;
    if (!hd()) devices::forcedimension::fake_dhd_as_it_is().devices[1].calibrated = false;
    RunOptions options;
    options.out = folder.path() + "/sessions";
    options.clock = Clock::real;
    const std::atomic<bool> stop{false};
    try {
        run_session(plan, options, stop, {});
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("needs calibration"), std::string::npos) << e.what();
    }
    EXPECT_TRUE(std::filesystem::is_empty(options.out));
}

TEST_P(RealDevices, ASessionIsRecordedAndReplayedToTheBitWithADropOfForce) {
    // the thumb pushes into the block from the left while the index finger waits; the thumb's
    // device cuts its force once, and later the index finger's device is lost
    constexpr int kDrop = 300;
    constexpr int kLost = 600;
    devices::openhaptics::FakeHd* const fake_hd =
        hd() ? &devices::openhaptics::fake_hd_as_it_is() : nullptr;
    devices::forcedimension::FakeDhd* const fake_dhd =
        hd() ? nullptr : &devices::forcedimension::fake_dhd_as_it_is();
    const devices::Hand hand = [](size_t i, double t, const Wrench&) {
        const double x = i == 0 ? -0.03 + std::min(0.015, 0.05 * t) : 0.06;
        return devices::Held{{x, 0, 0.02}, Vec3::Zero(), Quat::Identity(), Vec3::Zero()};
    };
    if (fake_hd != nullptr) fake_hd->hand = hand;
    if (fake_dhd != nullptr) fake_dhd->hand = hand;
    auto ticks = std::make_shared<int>(0);
    const auto happen = [=](size_t device) {
        if (device != 0) return;
        const int tick = ++*ticks;
        if (tick == kDrop && fake_hd != nullptr)
            fake_hd->raise(devices::openhaptics::kHdExceededMaxForce, 0);
        if (tick == kDrop && fake_dhd != nullptr)
            fake_dhd->cut(0, devices::forcedimension::kDhdByVelocity);
        if (tick == kLost && fake_hd != nullptr)
            fake_hd->raise(devices::openhaptics::kHdCommError, 1);
        if (tick == kLost && fake_dhd != nullptr) fake_dhd->devices[1].silent = true;
    };
    if (fake_hd != nullptr) fake_hd->in_frame = happen;
    if (fake_dhd != nullptr) fake_dhd->in_position = happen;

    const Plan plan = make_plan(request);
    *ticks = 0;
    RunOptions options;
    options.out = folder.path();
    options.clock = Clock::real;
    const std::atomic<bool> stop{false};
    const Recorded result = record(plan, options, stop);
    EXPECT_NE(result.fault.find("the index's device ("), std::string::npos) << result.fault;
    EXPECT_NE(result.fault.find("does not answer"), std::string::npos) << result.fault;
    EXPECT_NE(result.fault.find("Its driver reports: "), std::string::npos) << result.fault;
    EXPECT_EQ(result.info.clock, "real");
    EXPECT_GE(result.figures.ticks_with(kForceDropped), 1);
    EXPECT_GE(result.figures.ticks_with(kNotAnswering), 1);
    const ReplayResult replay = replay_session(result.folder, stop, {});
    EXPECT_GT(replay.ticks, kLost);
    EXPECT_EQ(replay.different_ticks, 0);
}

}  // namespace
}  // namespace dihaptic::session::real_devices_test
