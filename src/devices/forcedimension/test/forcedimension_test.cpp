// Tests the DHD backend on a fake libdhd: its readings, its failures, and the error messages.
#include <cmath>

#include "devices/forcedimension/backend.h"
#include "devices/forcedimension/dhd.h"
#include "devices/forcedimension/group.h"
#include "devices/test/making.h"
#include "fake_dhd.h"
#include "testing/bounds.h"

namespace dihaptic::devices::forcedimension::forcedimension_test {
namespace {

using std::chrono::milliseconds;

std::unique_ptr<DeviceGroup> make(const std::vector<std::string>& options,
                                  const std::string& library = DIHAPTIC_FAKE_DHD) {
    return make_devices(backend(), options, library);
}
std::unique_ptr<DeviceGroup> make_two() {
    return make({"serial: 101\n", "serial: 102\n"});
}

/// Runs ticks like a servo that commands a force along x.
class Ticks {
  public:
    explicit Ticks(DeviceGroup& group)
        : group_(group), readings_(static_cast<size_t>(group.size())) {
        group.activate();
    }
    const std::vector<Reading>& tick(double force = 0) {
        group_.read(n_++ * milliseconds(1), readings_);
        group_.write(std::vector<Wrench>(readings_.size(), {Vec3(force, 0, 0), Vec3::Zero()}));
        return readings_;
    }
    /// Returns the status of device i in the next tick.
    uint32_t status(size_t i, double force = 0) { return tick(force)[i].status; }

  private:
    DeviceGroup& group_;
    std::vector<Reading> readings_;
    int n_ = 0;
};

TEST(ForceDimension, FindsDevicesByTheirSerialNumbers) {
    FakeDhd& fake = fake_dhd();
    fake.devices[1].model = "sigma.7";
    const auto group = make({"serial: 102\n", "serial: 101\n"});
    EXPECT_EQ(group->info(0).model, "sigma.7, serial 102");
    EXPECT_EQ(group->info(1).model, "omega.3, serial 101");
    EXPECT_EQ(group->info(0).peak_force, 12);
    EXPECT_FALSE(group->info(0).workspace.has_value());
}

TEST(ForceDimension, OpensOnlyWhatItUsesAndClosesIt) {
    FakeDhd& fake = fake_dhd();
    {
        const auto group = make({"serial: 102\n"});
        EXPECT_FALSE(fake.devices[0].open);
        EXPECT_TRUE(fake.devices[1].open);
    }
    EXPECT_FALSE(fake.devices[1].open);
}

TEST(ForceDimension, ReadsAndPushesInSiUnitsAndInTheMakersAxes) {
    FakeDhd& fake = fake_dhd();
    Vec3 felt = Vec3::Zero();
    const Held held{{0.01, -0.02, 0.03}, {0.1, 0.2, -0.3}, Quat::Identity(), {}};
    fake.hand = [&](size_t i, double, const Wrench& push) {
        if (i == 1) felt = push.force;
        return held;
    };
    const auto group = make_two();
    Ticks ticks(*group);
    EXPECT_EQ(ticks.tick(1.5)[1].p_DH, held.p);
    EXPECT_EQ(ticks.tick(1.5)[1].v_DH, held.v);
    EXPECT_EQ(felt, Vec3(1.5, 0, 0));
    EXPECT_TRUE(fake.devices[0].gravity);
    group->deactivate();
    EXPECT_FALSE(fake.devices[0].force_enabled);
    EXPECT_EQ(fake.devices[0].acting, Vec3::Zero());
}

TEST(ForceDimension, WhatReturnsMoreThanZeroIsNoError) {
    FakeDhd& fake = fake_dhd();
    fake.devices[0].time_guard = true;
    const auto group = make_two();
    Ticks ticks(*group);
    EXPECT_EQ(ticks.status(0, 13), 0u);
    EXPECT_EQ(ticks.status(0, 1), uint32_t{kForceClamped});  // because of the last force
    EXPECT_EQ(ticks.status(0, 1), 0u);
}

TEST(ForceDimension, TheLibrarysFaultsAreTold) {
    fake_dhd();
    const auto with = [](const std::string& library) {
        return told([&] { make({"serial: 101\n"}, library); });
    };
    const std::string said = with("/nowhere/libdhd.so");
    expect_in(
        "rig.yaml:1: error: library: Force Dimension's SDK cannot be loaded; tried "
        "/nowhere/libdhd.so",
        said);
    expect_in("Install the Force Dimension SDK 3 for Linux", said);
    expect_in("has no dhdGetDeviceCount. This program does not support its version",
              with(DIHAPTIC_FAKE_HD));
}

TEST(ForceDimension, DevicesThatAreNotThereAreTold) {
    FakeDhd& fake = fake_dhd();
    std::string said = told([] { make({"serial: 103\n"}); });
    expect_in(
        "rig.yaml:1: error: serial: no device has serial number 103. Those connected are omega.3 "
        "101, omega.3 102.",
        said);
    expect_in("is needed: several devices are connected", told([] { make({""}); }));
    fake.devices[1].serial = 101;
    expect_in("two devices have serial number 101: they cannot be told apart",
              told([] { make({"serial: 101\n"}); }));
    fake.devices[0].in_use = true;
    EXPECT_EQ(make({""})->size(), 1);
    fake.devices[1].in_use = true;
    expect_in("cannot be opened: the device is in use. Close other programs",
              told([] { make({""}); }));
    fake.devices.clear();
    said = told([] { make({""}); });
    expect_in("no Force Dimension device is connected. Check its power", said);
    expect_in("udev rule for USB vendor 1451", said);
}

TEST(ForceDimension, NothingStaysOpenAfterAFailure) {
    FakeDhd& fake = fake_dhd();
    told([] { make({"serial: 101\n", "serial: 103\n"}); });
    EXPECT_FALSE(fake.devices[0].open);
    EXPECT_FALSE(fake.devices[1].open);
}

TEST(ForceDimension, RigsThatCannotBeAreRefusedWithoutADevice) {
    fake_dhd();
    expect_in("rig.yaml:2: error: serial: is needed", told([] { make({"serial: 101\n", ""}); }));
    expect_in("serial: '101' is also given for the thumb's device", told([] {
                  make({"serial: 101\n", "serial: 101\n"});
              }));
}

TEST(ForceDimension, ALargestForceMustBeKnown) {
    FakeDhd& fake = fake_dhd();
    fake.devices[0].max_force = -1;
    expect_in("Give options: peak_force_N, from its data sheet",
              told([] { make({"serial: 101\n"}); }));
    EXPECT_EQ(make({"serial: 101\npeak_force_N: 9\n"})->info(0).peak_force, 9);
    EXPECT_EQ(make({"serial: 102\npeak_force_N: 9\n"})->info(0).peak_force, 9);
    EXPECT_EQ(make({"serial: 102\npeak_force_N: 15\n"})->info(0).peak_force, 12);
}

TEST(ForceDimension, WhatKeepsADeviceFromStartingIsTold) {
    FakeDhd& fake = fake_dhd();
    fake.devices[0].calibrated = false;
    expect_in(
        "the thumb's device (omega.3, serial 101) needs calibration. Move it into all its end "
        "stops",
        told([] { make_two()->activate(); }));
    fake.devices[0].power = false;
    expect_in("has no power. Switch it on", told([] { make_two()->activate(); }));
    expect_in("does not answer: communication error", told([&] {
                  const auto group = make_two();
                  fake.devices[0].silent = true;
                  group->activate();
              }));
}

TEST(ForceDimension, OverVelocityTakesOneTicksForceAndIsArmedAgain) {
    FakeDhd& fake = fake_dhd();
    double speed = 0;
    fake.hand = [&](size_t i, double, const Wrench&) {
        return Held{{}, {i == 0 ? speed : 0, 0, 0}, Quat::Identity(), {}};
    };
    fake.devices[0].fastest = 0.5;
    const auto group = make_two();
    Ticks ticks(*group);
    EXPECT_EQ(ticks.status(0, 1), 0u);
    speed = 0.6;
    EXPECT_EQ(ticks.status(0, 1), uint32_t{kForceDropped});
    EXPECT_EQ(fake.devices[0].wanted, Vec3::Zero());
    speed = 0.1;
    EXPECT_EQ(ticks.status(0, 1), 0u);
    EXPECT_EQ(fake.devices[0].acting, Vec3(1, 0, 0));
    expect_in("faster than its velocity threshold", group->explain(0));
    speed = 0.6;
    uint32_t status = 0;
    for (int i = 0; i < 2500; ++i) status = ticks.status(0, 1);
    EXPECT_EQ(status, uint32_t{kDeviceFault});
}

TEST(ForceDimension, AForceThatNobodyRenewsEndsWithin32Ms) {
    FakeDhd& fake = fake_dhd();
    const auto group = make_two();
    Ticks ticks(*group);
    EXPECT_EQ(fake.devices[1].watchdog, 255);
    EXPECT_FALSE(fake.expert);
    ticks.tick(1.5);
    std::vector<Reading> readings(2);
    for (int ms = 1; ms <= 31; ++ms) group->read(milliseconds(ms), readings);
    EXPECT_EQ(fake.devices[0].acting, Vec3(1.5, 0, 0));
    group->read(milliseconds(32), readings);
    group->read(milliseconds(33), readings);
    EXPECT_EQ(fake.devices[0].acting, Vec3::Zero());
    EXPECT_EQ(fake.devices[1].acting, Vec3::Zero());
    EXPECT_EQ(readings[0].status, uint32_t{kForceDropped});
    expect_in("It received no command for 32 ms", group->explain(0));
    EXPECT_EQ(ticks.status(0, 1), uint32_t{kForceDropped});  // it is read before it is re-armed
    EXPECT_EQ(ticks.status(0, 1), 0u);
    EXPECT_EQ(fake.devices[0].acting, Vec3(1, 0, 0));
}

TEST(ForceDimension, WhatTheWatchdogEndsInAPauseWithoutForceIsNoDrop) {
    FakeDhd& fake = fake_dhd();
    const auto group = make_two();
    Ticks ticks(*group);
    for (const double force : {0.0, 1.0}) {  // first after activation, then after a pause
        std::vector<Reading> readings(2);
        for (int ms = 0; ms < 100; ++ms) group->read(milliseconds(ms), readings);
        EXPECT_FALSE(fake.devices[0].force_enabled);
        EXPECT_EQ(readings[0].status, 0u);
        EXPECT_EQ(ticks.status(0, force), 0u);
        EXPECT_TRUE(fake.devices[0].force_enabled);
        EXPECT_EQ(ticks.status(0, force), 0u);
        EXPECT_EQ(fake.devices[0].acting, Vec3(force, 0, 0));
        ticks.tick(0);
    }
}

TEST(ForceDimension, ADeviceWithoutAWatchdogIsUsedOnlyWhenTheRigSaysSo) {
    FakeDhd& fake = fake_dhd();
    fake.devices[0].has_watchdog = false;
    const std::string said = told([] { make_two()->activate(); });
    expect_in(
        "rig.yaml:1: error: watchdog: the thumb's device (omega.3, serial 101) has no usable "
        "watchdog: "
        "not available on this device",
        said);
    expect_in("the force may stay on if this program crashes", said);
    EXPECT_FALSE(fake.expert);
    EXPECT_FALSE(fake.devices[0].force_enabled);
    const auto group = make({"serial: 101\nwatchdog: no\n"});
    Ticks ticks(*group);
    EXPECT_EQ(ticks.status(0, 1), 0u);
    EXPECT_EQ(fake.devices[0].watchdog, 0);
    std::vector<Reading> readings(1);
    for (int ms = 1; ms <= 100; ++ms) group->read(milliseconds(ms), readings);
    EXPECT_EQ(fake.devices[0].acting, Vec3(1, 0, 0));
}

TEST(ForceDimension, NoDeviceIsToldMoreThanItsPeakOrThanItMayBe) {
    FakeDhd& fake = fake_dhd();
    fake.devices[0].max_force = 20;
    const auto group = make({"serial: 101\npeak_force_N: 9\n"});
    Ticks ticks(*group);
    ticks.tick(15);
    EXPECT_NEAR(fake.devices[0].wanted.norm(), 9, 1e-12);
    group->limit(0, 4, 0);
    EXPECT_EQ(ticks.status(0, 3.5), uint32_t{kForceClamped});
    EXPECT_EQ(fake.devices[0].wanted, Vec3(3.5, 0, 0));
    EXPECT_EQ(ticks.status(0, 15), 0u);
    EXPECT_NEAR(fake.devices[0].wanted.norm(), 4, 1e-12);
    group->limit(0, 100, 0);
    ticks.tick(15);
    EXPECT_NEAR(fake.devices[0].wanted.norm(), 9, 1e-12);
    ticks.tick(std::nan(""));
    EXPECT_EQ(fake.devices[0].wanted, Vec3::Zero());
}

TEST(ForceDimension, AnActiveWristIsReadAndTurned) {
    FakeDhd& fake = fake_dhd();
    fake.devices[0].wrist = fake.devices[0].active_wrist = fake.devices[1].wrist = true;
    fake.devices[0].max_torque = 0.4;
    const Held held{{0.01, 0, 0}, {}, rotation_xyz({0.3, -0.2, 0.5}), {1, 2, -3}};
    Wrench felt;
    fake.hand = [&](size_t i, double, const Wrench& push) {
        if (i == 0) felt = push;
        return held;
    };
    const auto group = make({"serial: 101\ncontinuous_torque_mNm: 100\n", "serial: 102\n"});
    EXPECT_TRUE(group->info(0).measures_orientation);
    EXPECT_EQ(group->info(0).peak_torque, 0.4);
    EXPECT_DOUBLE_EQ(group->info(0).continuous_torque, 0.1);
    EXPECT_TRUE(group->info(1).measures_orientation);  // like an omega.6, whose wrist is passive
    EXPECT_EQ(group->info(1).peak_torque, 0);
    group->activate();
    std::vector<Reading> readings(2);
    const std::vector<Wrench> wrenches(2, {Vec3(1, 2, 3), Vec3(0.1, -0.2, 0.05)});
    for (int ms = 0; ms < 2; ++ms) {
        group->read(milliseconds(ms), readings);
        group->write(wrenches);
    }
    EXPECT_LT(angle_between(readings[0].R_DH, held.R), 1e-12);
    EXPECT_EQ(readings[1].w_DH, held.w);
    EXPECT_EQ(felt.force, wrenches[0].force);
    EXPECT_EQ(felt.torque, wrenches[0].torque);
    EXPECT_EQ(fake.devices[1].acting_torque, Vec3::Zero());
    group->write(std::vector<Wrench>(2, {Vec3::Zero(), Vec3(0, 5, 0)}));
    EXPECT_TRUE(fake.devices[0].acting_torque.isApprox(Vec3(0, 0.4, 0)));
    group->deactivate();
    EXPECT_EQ(fake.devices[0].acting_torque, Vec3::Zero());
}

TEST(ForceDimension, TorqueNeedsOrientationAndALargestOne) {
    FakeDhd& fake = fake_dhd();
    fake.devices[0].wrist = fake.devices[0].active_wrist = true;
    EXPECT_EQ(make({"serial: 101\n"})->info(0).peak_torque, 0);
    EXPECT_DOUBLE_EQ(make({"serial: 101\npeak_torque_Nm: 0.2\n"})->info(0).peak_torque, 0.2);
    EXPECT_FALSE(make({"serial: 101\norientation: no\n"})->info(0).measures_orientation);
    for (const char* options : {"serial: 101\norientation: no\n", "serial: 102\n"}) {
        expect_in("renders no torque. Leave it out",
                  told([&] { make({std::string(options) + "peak_torque_Nm: 0.2\n"}); }));
    }
    fake.devices[0].max_torque = 0.1;
    EXPECT_EQ(make({"serial: 101\npeak_torque_Nm: 0.2\n"})->info(0).peak_torque, 0.1);
}

TEST(ForceDimension, ADeadManSwitchMayBeLetGoForLong) {
    FakeDhd& fake = fake_dhd();
    const auto group = make_two();
    Ticks ticks(*group);
    for (int i = 0; i < 3000; ++i) {
        fake.cut(1, kDhdByDeadMan);
        ASSERT_EQ(ticks.status(1, 1), uint32_t{kForceDropped});
    }
    EXPECT_EQ(ticks.status(1, 1), 0u);
}

struct Bad {
    const char* name;
    void (*happen)(FakeDhd& fake);
    uint32_t status;
};
void PrintTo(const Bad& bad, std::ostream* out) {
    *out << bad.name;
}
class DhdLosses : public ::testing::TestWithParam<Bad> {};

TEST_P(DhdLosses, ShowInTheNextReadingOfThatDeviceAlone) {
    FakeDhd& fake = fake_dhd();
    const auto group = make_two();
    Ticks ticks(*group);
    EXPECT_EQ(ticks.status(1), 0u);
    GetParam().happen(fake);
    EXPECT_EQ(ticks.status(1), GetParam().status);
    EXPECT_EQ(ticks.status(0), 0u);
}
INSTANTIATE_TEST_SUITE_P(
    ForceDimension, DhdLosses,
    ::testing::Values(
        Bad{"silent", [](FakeDhd& fake) { fake.devices[1].silent = true; }, kNotAnswering},
        Bad{"no power", [](FakeDhd& fake) { fake.devices[1].power = false; }, kNotAnswering},
        Bad{"unplugged", [](FakeDhd& fake) { fake.devices[1].connected = false; }, kNotAnswering},
        Bad{"USB failed", [](FakeDhd& fake) { fake.cut(1, kDhdByUsb); }, kNotAnswering},
        Bad{"uncalibrated", [](FakeDhd& fake) { fake.devices[1].calibrated = false; },
            kUncalibrated},
        Bad{"broken", [](FakeDhd& fake) { fake.devices[1].broken = true; }, kDeviceFault}));

TEST(ForceDimension, SurveysWhatIsThere) {
    const Survey found = backend().survey();
    if (found.missing.empty()) GTEST_SKIP() << "this machine has the library";
    EXPECT_TRUE(found.devices.empty());
    expect_in("cannot be loaded; tried libdhd.so.3 (", found.missing);
    expect_in("libdrd.so (", found.missing);
}

TEST(DhdOptions, HaveBounds) {
    testing::expect_bounds<Options>();
}

}  // namespace
}  // namespace dihaptic::devices::forcedimension::forcedimension_test
