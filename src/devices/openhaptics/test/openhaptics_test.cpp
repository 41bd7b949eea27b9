// Tests the HD backend on a fake libHD: its readings, its failures, and the error messages.
#include <thread>

#include "devices/openhaptics/backend.h"
#include "devices/openhaptics/group.h"
#include "devices/openhaptics/hd.h"
#include "devices/test/making.h"
#include "fake_hd.h"
#include "model/phantom_arm.h"
#include "testing/bounds.h"

namespace dihaptic::devices::openhaptics::openhaptics_test {
namespace {

using std::chrono::milliseconds;

const char* const kTwo[] = {"name: PHANToM 1\n", "name: PHANToM 2\n"};

std::unique_ptr<DeviceGroup> make(const std::vector<std::string>& options, double tick = 1e-3,
                                  const std::string& library = DIHAPTIC_FAKE_HD) {
    return make_devices(backend(), options, library, tick);
}
std::unique_ptr<DeviceGroup> make_two() {
    return make({kTwo[0], kTwo[1]});
}

/// Runs `ticks` ticks through pace() like a servo that commands `force`, and keeps the readings of
/// each tick.
struct Paced {
    std::vector<std::vector<Reading>> readings;
    explicit Paced(DeviceGroup& group, int ticks, const Vec3& force = Vec3::Zero(),
                   const Vec3& torque = Vec3::Zero()) {
        int n = 0;
        group.pace([&] {
            std::vector<Reading> now(static_cast<size_t>(group.size()));
            group.read(n * milliseconds(1), now);
            group.write(std::vector<Wrench>(now.size(), {force, torque}));
            readings.push_back(now);
            return ++n < ticks;
        });
    }
};

TEST(OpenHaptics, ReadsWhatTheDevicesAreAndCan) {
    FakeHd& fake = fake_hd();
    fake.devices[1].input_dof = 6;
    const auto group = make({kTwo[0], kTwo[1]});
    const frame::DeviceInfo& info = group->info(0);
    EXPECT_EQ(info.model, "PHANToM Premium 1.0, serial 40123");
    EXPECT_EQ(info.peak_force, 8.5);
    EXPECT_EQ(info.continuous_force, 1.4);
    EXPECT_DOUBLE_EQ(*info.max_stiffness, 1000);
    EXPECT_DOUBLE_EQ(*info.max_damping, 5);
    EXPECT_TRUE(info.workspace->isApprox(Vec3(0.254, 0.178, 0.127)));
    EXPECT_FALSE(info.measures_orientation);
    EXPECT_TRUE(group->info(1).measures_orientation);
}

TEST(OpenHaptics, OptionsComeBeforeWhatTheDeviceSays) {
    FakeHd& fake = fake_hd();
    fake.devices[0].input_dof = 6;
    const auto group = make({"max_stiffness_N_m: 500\nmax_damping_Ns_m: 2\norientation: no\n"});
    EXPECT_EQ(*group->info(0).max_stiffness, 500);
    EXPECT_EQ(*group->info(0).max_damping, 2);
    EXPECT_FALSE(group->info(0).measures_orientation);
}

TEST(OpenHaptics, ConvertsUnitsAndPutsTheOriginInTheMiddleOfTheWorkspace) {
    FakeHd& fake = fake_hd();
    fake.devices[0].input_dof = 6;
    const Held held{
        {0.01, -0.02, 0.03}, {0.1, 0.2, -0.3}, rotation_xyz({0.1, 0.2, 0.3}), {1, 2, 3}};
    fake.hand = [&](size_t, double, const Wrench&) { return held; };
    const auto group = make({""});
    group->activate();
    const Reading reading = Paced(*group, 1).readings[0][0];
    EXPECT_TRUE(reading.p_DH.isApprox(held.p, 1e-12));
    EXPECT_TRUE(reading.v_DH.isApprox(held.v, 1e-12));
    EXPECT_LT(angle_between(reading.R_DH, held.R), 1e-12);
    EXPECT_TRUE(reading.w_DH.isApprox(held.w, 1e-12));
    EXPECT_EQ(reading.status, 0u);
}

TEST(OpenHaptics, TellsTheJointsOfAnArmThatIsAskedForThem) {
    FakeHd& fake = fake_hd();
    const Vec3 q(0.3, -0.2, 0.4);
    const Vec3 offset(0.01, 0.02, -0.01);
    fake.devices[0].joint_offset = offset;
    fake.hand = [&](size_t, double, const Wrench&) { return Held{model::phantom_position({}, q)}; };
    const auto group = make({"joint_angles: yes\n"});
    ASSERT_TRUE(group->info(0).arm);
    // HD's own origin is not in the middle of the workspace, so the smaller side determines the
    // size of the box
    EXPECT_TRUE(group->info(0).workspace->isApprox(Vec3(0.254, 0.120, 0.080)));
    group->activate();
    const Reading reading = Paced(*group, 1).readings[0][0];
    EXPECT_TRUE(reading.joints.isApprox(q - offset, 1e-9)) << reading.joints.transpose();
    EXPECT_TRUE(reading.p_DH.isApprox(model::phantom_position({}, reading.joints), 1e-9));
}

TEST(OpenHaptics, RefusesJointsOfADeviceThatTellsNone) {
    fake_hd();
    expect_in("does not report its joint angles. Leave out joint_angles.",
              told([] { make({"joint_angles: yes\n"}); }));
}

TEST(OpenHaptics, SaysWhenAHandleLeavesTheWorkspace) {
    FakeHd& fake = fake_hd();
    fake.hand = [&](size_t i, double, const Wrench&) {
        return Held{{i == 0 ? 0.126 : 0.128, 0, 0}, {}, Quat::Identity(), {}};
    };
    const auto group = make_two();
    group->activate();
    const auto readings = Paced(*group, 1).readings[0];
    EXPECT_EQ(readings[0].status, 0u);
    EXPECT_EQ(readings[1].status, uint32_t{kOutsideWorkspace});
}

TEST(OpenHaptics, ForcesReachTheHandInNewtonsAndEndWithTheScheduler) {
    FakeHd& fake = fake_hd();
    fake.ramp = 1e9;
    const auto group = make_two();
    group->activate();
    Vec3 felt = Vec3::Zero();
    fake.hand = [&](size_t i, double, const Wrench& push) {
        if (i == 1) felt = push.force;
        return Held{};
    };
    const Paced run(*group, 3, {1, -2, 3});
    EXPECT_EQ(felt, Vec3(1, -2, 3));
    EXPECT_EQ(fake.devices[0].acting, Vec3::Zero());
    EXPECT_EQ(fake.devices[1].acting, Vec3::Zero());
    group->deactivate();
    EXPECT_FALSE(fake.devices[0].force_enabled);
    EXPECT_EQ(fake.violations, 0);
    EXPECT_EQ(fake.callbacks_left, 0);
}

TEST(OpenHaptics, ForceRampsUpWhenTheSchedulerStarts) {
    FakeHd& fake = fake_hd();
    fake.ramp = 100;
    const auto group = make({""});
    group->activate();
    std::vector<double> felt;
    fake.hand = [&](size_t, double, const Wrench& push) {
        felt.push_back(push.force.x());
        return Held{};
    };
    const Paced run(*group, 50, {2, 0, 0});
    EXPECT_NEAR(felt[10], 1, 1e-9);  // after 10 ms at 100 N/s
    EXPECT_EQ(felt[49], 2);
}

TEST(OpenHaptics, TorqueReachesTheHandOfADeviceWithSixDegreesOfOutput) {
    FakeHd& fake = fake_hd();
    fake.ramp = 1e9;
    for (FakeHd::Device& device : fake.devices) device.input_dof = 6;
    fake.devices[0].output_dof = 6;
    fake.devices[0].max_torque = 515;  // mN*m
    fake.devices[0].continuous_torque = 188;
    Wrench felt[2];
    fake.hand = [&](size_t i, double, const Wrench& push) {
        felt[i] = push;
        return Held{};
    };
    const auto group = make_two();
    EXPECT_DOUBLE_EQ(group->info(0).peak_torque, 0.515);
    EXPECT_DOUBLE_EQ(group->info(0).continuous_torque, 0.188);
    EXPECT_EQ(group->info(1).peak_torque, 0);
    group->activate();
    const Paced run(*group, 3, {1, 0, 0}, {0.1, -0.2, 0.3});
    EXPECT_EQ(run.readings[2][0].status, 0u);
    EXPECT_TRUE(felt[0].torque.isApprox(Vec3(0.1, -0.2, 0.3), 1e-12));
    EXPECT_EQ(felt[1].torque, Vec3::Zero());
    EXPECT_EQ(fake.devices[0].acting_torque, Vec3::Zero());
    EXPECT_EQ(fake.violations, 0);
}

TEST(OpenHaptics, TorqueNeedsOrientationAndALargestOne) {
    FakeHd& fake = fake_hd();
    fake.devices[0].input_dof = fake.devices[0].output_dof = 6;
    EXPECT_EQ(make({""})->info(0).peak_torque, 0);
    {
        const auto given = make({"peak_torque_mNm: 300\ncontinuous_torque_mNm: 100\n"});
        EXPECT_DOUBLE_EQ(given->info(0).peak_torque, 0.3);
        EXPECT_DOUBLE_EQ(given->info(0).continuous_torque, 0.1);
    }
    fake.devices[0].max_torque = 200;
    EXPECT_DOUBLE_EQ(make({"orientation: no\n"})->info(0).peak_torque, 0);
    expect_in("renders no torque. Leave it out",
              told([] { make({"orientation: no\npeak_torque_mNm: 300\n"}); }));
    fake.devices[0].output_dof = 3;
    EXPECT_EQ(make({""})->info(0).peak_torque, 0);
}

TEST(OpenHaptics, TheLibrarysFaultsAreTold) {
    fake_hd();
    const auto with = [](const std::string& library) {
        return told([&] { make({""}, 1e-3, library); });
    };
    std::string said = with("/nowhere/libHD.so");
    expect_in("rig.yaml:1: error: library: OpenHaptics cannot be loaded; tried /nowhere/libHD.so",
              said);
    expect_in("Install OpenHaptics 3.4 for Linux and the device driver from 3D Systems", said);
    said = with(DIHAPTIC_FAKE_DHD);
    expect_in("has no hdInitDevice. This program does not support its version", said);
}

TEST(OpenHaptics, DevicesThatAreNotThereAreTold) {
    FakeHd& fake = fake_hd();
    std::string said = told([] { make({"name: PHANToM 3\n"}); });
    expect_in(
        "rig.yaml:1: error: name: the thumb's device 'PHANToM 3' cannot be reached: "
        "HD_BAD_HANDLE",
        said);
    expect_in("check its name in the driver's configuration", said);
    fake.init_error = kHdInvalidLicence;
    expect_in("OH_SDK_LICENSE_PATH", told([] { make({""}); }));
    fake.init_error = kHdCommError;
    expect_in("EPP mode", told([] { make({""}); }));
    const auto first = make({kTwo[0]});
    expect_in("HD_DEVICE_ALREADY_INITIATED, it is in use. Close the other program",
              told([] { make({kTwo[0]}); }));
    EXPECT_FALSE(fake.devices[1].initialised);
}

TEST(OpenHaptics, NothingStaysInitialisedAfterAFailure) {
    FakeHd& fake = fake_hd();
    told([] { make({kTwo[0], "name: PHANToM 3\n"}); });
    EXPECT_FALSE(fake.devices[0].initialised);
    EXPECT_EQ(make_two()->size(), 2);
    EXPECT_FALSE(fake.devices[0].initialised);
    EXPECT_FALSE(fake.devices[1].initialised);
}

TEST(OpenHaptics, SerialNumbersAreChecked) {
    FakeHd& fake = fake_hd();
    EXPECT_EQ(make({"name: PHANToM 1\nserial: 40123\n"})->size(), 1);
    std::string said = told([] { make({"name: PHANToM 1\nserial: 40124\n"}); });
    expect_in("(PHANToM Premium 1.0, serial 40123) does not have serial number 40124", said);
    fake.devices[1].serial = "40123";
    said = told([] { make_two(); });
    expect_in("rig.yaml:2: error: name: the index's device 'PHANToM 2'", said);
    expect_in("have the same serial number: they are one device under two names", said);
    EXPECT_FALSE(fake.devices[0].initialised);
}

TEST(OpenHaptics, RigsThatCannotBeAreRefusedWithoutADevice) {
    fake_hd();
    expect_in("rig.yaml:2: error: name: is needed", told([] { make({kTwo[0], ""}); }));
    expect_in("name: 'PHANToM 1' is also given for the thumb's device", told([] {
                  make({kTwo[0], kTwo[0]});
              }));
    expect_in("serial: '7' is also given for the thumb's device", told([] {
                  make({"name: A\nserial: 7\n", "name: B\nserial: 7\n"});
              }));
}

TEST(OpenHaptics, LimitsThatCannotBeAreRefused) {
    FakeHd& fake = fake_hd();
    fake.devices[0].max_force = 0;
    expect_in("states impossible limits: 0 N peak", told([] { make({""}); }));
}

TEST(OpenHaptics, RatesThatTheDriverRefusesAreTold) {
    fake_hd();
    const auto group = make({""}, 1.0 / 300);
    const std::string said = told([&] { group->activate(); });
    expect_in("does not run at 300 ticks per second: HD_INVALID_VALUE", said);
}

TEST(OpenHaptics, CalibratesWhatCalibratesItself) {
    FakeHd& fake = fake_hd();
    fake.devices[0].style = kHdAuto;
    fake.devices[0].calibration = kHdNeedsUpdate;
    fake.devices[1].style = kHdInkwell | kHdAuto;
    const auto group = make_two();
    group->activate();
    EXPECT_EQ(fake.devices[0].calibration, unsigned{kHdOk});
    EXPECT_EQ(fake.violations, 0);
}

TEST(OpenHaptics, ResetsEncodersOnlyWhenAsked) {
    FakeHd& fake = fake_hd();
    fake.devices[0].calibration = kHdNeedsUpdate;
    std::string said = told([] { make({kTwo[0]})->activate(); });
    expect_in("needs calibration. Hold it in its neutral pose, both links at right angles", said);
    EXPECT_EQ(fake.devices[0].resets, 0);
    make({"name: PHANToM 1\nencoder_reset: yes\n"})->activate();
    EXPECT_EQ(fake.devices[0].resets, 1);
    EXPECT_EQ(fake.violations, 0);
}

TEST(OpenHaptics, ADeviceThatNeedsAPersonToCalibrateIsTold) {
    FakeHd& fake = fake_hd();
    fake.devices[0].style = kHdInkwell;
    fake.devices[0].calibration = kHdNeedsUpdate;
    fake.devices[0].updated = kHdNeedsHand;
    expect_in("Put its stylus into the inkwell", told([] { make({kTwo[0]})->activate(); }));
}

class HdForceErrors : public ::testing::TestWithParam<unsigned> {};

TEST_P(HdForceErrors, TakeOneTicksForceAndAreArmedAgain) {
    FakeHd& fake = fake_hd();
    fake.ramp = 1e9;
    fake.before_tick = [&](int tick) {
        if (tick == 10) fake.raise(GetParam(), 1);
        if (tick == 10) fake.devices[1].force_enabled = false;
        return true;
    };
    std::vector<double> felt[2];
    fake.hand = [&](size_t i, double, const Wrench& push) {
        felt[i].push_back(push.force.norm());
        return Held{};
    };
    const auto group = make_two();
    group->activate();
    const Paced run(*group, 20, {1, 0, 0});
    EXPECT_EQ(run.readings[9][1].status, 0u);
    EXPECT_EQ(run.readings[10][1].status, uint32_t{kForceDropped});
    EXPECT_EQ(run.readings[10][0].status, 0u);
    EXPECT_EQ(run.readings[11][1].status, 0u);
    EXPECT_EQ(felt[1][10], 0);  // in this tick, the device cut its force
    EXPECT_EQ(felt[1][11], 0);  // in this tick, zero was written
    EXPECT_EQ(felt[1][12], 1);
    EXPECT_NE(group->explain(1), "");
    EXPECT_EQ(group->explain(0), "");
}
INSTANTIATE_TEST_SUITE_P(OpenHaptics, HdForceErrors,
                         ::testing::Values(kHdWarmMotors, kHdExceededMaxForce,
                                           kHdExceededMaxImpulse, kHdExceededMaxVelocity,
                                           kHdForceError));

TEST(OpenHaptics, AForceErrorThatStaysIsAFault) {
    FakeHd& fake = fake_hd();
    fake.before_tick = [&](int) {
        fake.raise(kHdWarmMotors, 0);
        return true;
    };
    const auto group = make_two();
    group->activate();
    const Paced run(*group, 2100);
    EXPECT_EQ(run.readings[1990][0].status, uint32_t{kForceDropped});
    EXPECT_EQ(run.readings[2010][0].status, uint32_t{kDeviceFault});
    expect_in("its motors are hot. Let them cool", group->explain(0));
}

struct Bad {
    unsigned code;
    uint32_t status;
};
class HdLosses : public ::testing::TestWithParam<Bad> {};

TEST_P(HdLosses, LeaveADeviceAloneForGoodAndTheOthersInTheirFrames) {
    FakeHd& fake = fake_hd();
    fake.before_tick = [&](int tick) {
        if (tick == 10) fake.raise(GetParam().code, 0);
        return true;
    };
    const auto group = make_two();
    group->activate();
    const Paced run(*group, 20);
    EXPECT_EQ(run.readings[9][0].status, 0u);
    for (size_t i = 10; i < 20; ++i) {
        EXPECT_EQ(run.readings[i][0].status, GetParam().status);
        EXPECT_EQ(run.readings[i][1].status, 0u);
    }
    EXPECT_EQ(fake.devices[0].frames, 11);
    EXPECT_EQ(fake.devices[1].frames, 20);
    EXPECT_NE(group->explain(0), "");
    group->deactivate();
    group->activate();  // activating the group again recovers the device
    EXPECT_EQ(Paced(*group, 1).readings[0][0].status, 0u);
}
INSTANTIATE_TEST_SUITE_P(OpenHaptics, HdLosses,
                         ::testing::Values(Bad{kHdCommError, kNotAnswering},
                                           Bad{kHdCommConfigError, kNotAnswering},
                                           Bad{kHdTimerError, kNotAnswering},
                                           Bad{kHdDeviceFault, kDeviceFault}));

TEST(OpenHaptics, ASchedulerThatGoesSilentEndsInOrder) {
    FakeHd& fake = fake_hd();
    fake.before_tick = [](int tick) { return tick < 10; };
    const auto group = make_two();
    group->activate();
    const auto begin = std::chrono::steady_clock::now();
    const Paced run(*group, 20);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
    for (size_t i = 0; i < 20; ++i) {
        EXPECT_EQ(run.readings[i][0].status, i < 10 ? 0u : uint32_t{kNotAnswering}) << i;
        EXPECT_EQ(run.readings[i][1].status, i < 10 ? 0u : uint32_t{kNotAnswering}) << i;
    }
    EXPECT_EQ(fake.devices[0].acting, Vec3::Zero());
    EXPECT_EQ(fake.callbacks_left, 0);
    EXPECT_EQ(fake.violations, 0);
}

TEST(OpenHaptics, ATickThatBlocksIsWaitedFor) {
    FakeHd& fake = fake_hd();
    fake.in_frame = [&](size_t device) {
        if (device == 1 && fake.devices[0].frames == 10)
            std::this_thread::sleep_for(milliseconds(250));
    };
    const auto group = make_two();
    group->activate();
    const Paced run(*group, 20);
    EXPECT_EQ(run.readings[19][0].status, 0u);
}

TEST(OpenHaptics, SurveysWhatIsThere) {
    const Survey found = backend().survey();
    if (found.missing.empty()) GTEST_SKIP() << "this machine has the library";
    EXPECT_TRUE(found.devices.empty());
    expect_in("OpenHaptics cannot be loaded; tried libHD.so (", found.missing);
    expect_in("libHD.so.3.4 (", found.missing);
    expect_in("libHD.so.3.0 (", found.missing);
}

TEST(FakeHd, ADeviceInitialisedLateTakesPartAfterARestart) {
    FakeHd& fake = fake_hd();
    const Hd hd = load_hd(DIHAPTIC_FAKE_HD, {});
    const HdHandle first = hd.init_device("PHANToM 1");
    hd.start_scheduler();
    const HdHandle second = hd.init_device("PHANToM 2");
    EXPECT_TRUE(fake.devices[second].late);
    hd.stop_scheduler();
    hd.start_scheduler();
    EXPECT_FALSE(fake.devices[second].late);
    hd.stop_scheduler();
    hd.disable_device(first);
    hd.disable_device(second);
}

TEST(FakeHd, RefusesFramesThatAreMixedUp) {
    fake_hd();
    const Hd hd = load_hd(DIHAPTIC_FAKE_HD, {});
    const HdHandle device = hd.init_device(nullptr);
    hd.end_frame(device);
    EXPECT_EQ(hd.get_error().code, unsigned{kHdIllegalEnd});
    hd.begin_frame(device);
    hd.begin_frame(device);
    EXPECT_EQ(hd.get_error().code, unsigned{kHdIllegalBegin});
    EXPECT_EQ(hd.get_error().code, unsigned{kHdSuccess});
    hd.end_frame(device);
    hd.disable_device(device);
    hd.begin_frame(device);
    EXPECT_EQ(hd.get_error().code, unsigned{kHdBadHandle});
}

TEST(HdOptions, HaveBounds) {
    testing::expect_bounds<Options>();
}

}  // namespace
}  // namespace dihaptic::devices::openhaptics::openhaptics_test
