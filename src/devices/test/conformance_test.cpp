// Tests that every backend in the table fulfils the contract of device_group.h.
#include <gtest/gtest.h>

#include <thread>

#include "devices/device_group.h"
#include "fakes.h"
#include "testing/allocation_guard.h"

namespace dihaptic::devices::conformance_test {
namespace {

class StillDriver final : public hand::Driver {
  public:
    double duration() const override { return 1; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    hand::FingerTarget do_target(int finger, double) const noexcept override {
        return {{0.01 * finger, 0.02, 0.03}, Vec3::Zero()};
    }
    std::vector<Phase> phases_{{"still", 0, 1}};
};

class Conformance : public ::testing::TestWithParam<std::string> {
  protected:
    Conformance() {
        context.driver = &driver_;
        context.recording.devices.resize(2);
        for (frame::DeviceInfo& info : context.recording.devices) info.model = "recorded";
        context.recording.read = [](Time now, std::span<Reading> readings) {
            for (size_t i = 0; i < readings.size(); ++i)
                readings[i].p_DH = Vec3(static_cast<double>(i), seconds(now), 0);
            return now < std::chrono::seconds(1);
        };
        const Pose X_WD{rotation_xyz({0.3, 0.1, -0.5}), {0.1, 0.2, 0.3}};
        made_.configs = {{"thumb", {}, {}}, {"index", X_WD, {}}};
        if (const StandIn* fake = find_stand_in(GetParam()))
            made_ = fake->make(made_.configs, context);
    }
    const Backend& backend() const { return *find_backend(GetParam()); }
    const std::vector<DeviceConfig>& configs() const { return made_.configs; }
    std::unique_ptr<DeviceGroup> make() const { return backend().make(configs(), context); }

    Context context;

  private:
    StillDriver driver_;
    StandIn::Made made_;
};

TEST_P(Conformance, LivesThroughItsLifeCycleTwice) {
    const auto group = make();
    ASSERT_EQ(group->size(), 2);
    EXPECT_FALSE(group->info(0).model.empty());
    std::vector<Reading> readings(2);
    const std::vector<Wrench> forces(2, {Vec3(0.1, 0, 0), Vec3::Zero()});
    for (int life = 0; life < 2; ++life) {
        group->activate();
        for (int i = 0; i < 10; ++i) {
            group->read(i * std::chrono::milliseconds(1), readings);
            group->write(forces);
            for (const Reading& reading : readings) {
                EXPECT_TRUE(reading.p_DH.allFinite());
                EXPECT_TRUE(reading.v_DH.allFinite());
            }
        }
        group->deactivate();
        group->deactivate();  // a second call is harmless
    }
}

TEST_P(Conformance, AllocatesNothingInTheCycle) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    const auto group = make();
    std::vector<Reading> readings(2);
    const std::vector<Wrench> forces(2, {Vec3(0.1, 0, 0), Vec3::Zero()});
    group->activate();
    const testing::AllocationGuard guard;
    for (int i = 0; i < 100; ++i) {
        group->read(i * std::chrono::milliseconds(1), readings);
        group->write(forces);
    }
    EXPECT_EQ(guard.count(), 0u);
}

TEST_P(Conformance, SaysThatItWasAskedForMoreThanItCanAndBearsWhatIsNoNumber) {
    const auto group = make();
    std::vector<Reading> readings(2);
    group->activate();
    const auto status = [&](int tick, const Vec3& force) {
        readings.assign(2, {});
        group->read(tick * std::chrono::milliseconds(1), readings);
        group->write(std::vector<Wrench>(2, {force, Vec3::Zero()}));
        return readings[0].status & kForceClamped;
    };
    group->limit(0, 0.2, 0);
    group->limit(1, 0.2, 0);
    EXPECT_EQ(status(0, {0.1, 0, 0}), 0u);
    EXPECT_EQ(status(1, {0.3, 0, 0}), 0u);
    EXPECT_EQ(status(2, Vec3::Constant(std::nan(""))), unsigned{kForceClamped});
    EXPECT_EQ(status(3, {0.1, 0, 0}), 0u);
    EXPECT_TRUE(readings[0].p_DH.allFinite());
}

TEST_P(Conformance, WhatCanBeStoppedCanBeFromAnyThreadAndStaysSoUntilActivated) {
    const auto group = make();
    if (!group->can_stop()) GTEST_SKIP() << "cannot be stopped from another thread: see its README";
    std::vector<Reading> readings(2);
    const std::vector<Wrench> forces(2, {Vec3(2, 0, 0), Vec3::Zero()});
    Time now{0};
    const auto tick = [&](const std::vector<Wrench>& wrenches) {
        group->read(now, readings);
        group->write(wrenches);
        now += std::chrono::milliseconds(1);
    };
    // distance that a force of 2 N pushes the hand in 50 ms, starting from rest [m]
    const auto pushed = [&] {
        for (int i = 0; i < 2000; ++i) tick({2, Wrench{}});
        const Vec3 begin = readings[0].p_DH;
        for (int i = 0; i < 50; ++i) tick(forces);
        group->read(now, readings);
        return (readings[0].p_DH - begin).norm();
    };
    group->activate();
    EXPECT_GT(pushed(), 1e-3);
    group->deactivate();
    group->activate();
    std::thread([&] { group->stop(); }).join();
    EXPECT_LT(pushed(), 1e-9);
    group->deactivate();
    group->activate();
    EXPECT_GT(pushed(), 1e-3);
    // stops the group while another thread is in a tick (the thread sanitizer checks this)
    std::thread stopper([&] { group->stop(); });
    for (int i = 0; i < 30; ++i) tick(forces);
    stopper.join();
}

TEST_P(Conformance, PacesUntilItIsToldToEndAndThenAgain) {
    const auto group = make();
    if (!group->paces()) return;
    std::vector<Reading> readings(2);
    const std::vector<Wrench> none(2);
    group->activate();
    for (int run = 0; run < 2; ++run) {
        int ticks = 0;
        group->pace([&] {
            group->read(ticks * std::chrono::milliseconds(1), readings);
            group->write(none);
            return ++ticks < 20;
        });
        EXPECT_EQ(ticks, 20);
        EXPECT_EQ(readings[0].status, 0u);
        group->write(none);  // a zero force, as written by a servo between runs
    }
    group->deactivate();
}

TEST_P(Conformance, RefusesOptionsThatItDoesNotKnow) {
    Diagnostics diagnostics;
    backend().describe({{"thumb", {}, parse_yaml("no_such_option: 1\n", "rig.yaml")}}, {},
                       diagnostics);
    EXPECT_TRUE(diagnostics.has_errors());
}

TEST_P(Conformance, ItsOptionsSayNothingElseThanItsDevicesDo) {
    Diagnostics diagnostics;
    const std::vector<frame::DeviceInfo> described =
        backend().describe(configs(), context, diagnostics);
    const auto group = make();
    ASSERT_EQ(described.size(), 2u);
    for (size_t i = 0; i < described.size(); ++i) {
        const frame::DeviceInfo& said = described[i];
        const frame::DeviceInfo& is = group->descriptions()[i];
        EXPECT_FALSE(said.model.empty());
        EXPECT_EQ(said.simulated, is.simulated);
        if (!said.serial.empty()) {
            EXPECT_EQ(said.serial, is.serial);
        }
        // the information is either complete or lacks only values that an open device reports
        if (std::isfinite(said.peak_force)) {
            EXPECT_EQ(said, is);
        }
        EXPECT_TRUE(std::isfinite(is.peak_force) || !backend().real);
    }
}

std::vector<std::string> names() {
    std::vector<std::string> out;
    for (const Backend& backend : backends()) out.emplace_back(backend.name);
    return out;
}
INSTANTIATE_TEST_SUITE_P(DeviceTable, Conformance, ::testing::ValuesIn(names()));

TEST(DeviceTable, SaysWhichDevicesAreReal) {
    for (const Backend& backend : backends()) {
        EXPECT_EQ(backend.real, find_stand_in(backend.name) != nullptr) << backend.name;
        EXPECT_EQ(backend.survey != nullptr, backend.real) << backend.name;
    }
}

TEST(DeviceTable, HasSimulatedAndReplay) {
    EXPECT_NE(find_backend("simulated"), nullptr);
    EXPECT_NE(find_backend("replay"), nullptr);
    EXPECT_EQ(find_backend("telepathy"), nullptr);
}

TEST(Replay, SaysWhenTheRecordingEnds) {
    Context context;
    context.recording = {std::vector<frame::DeviceInfo>(1), [](auto, auto) { return false; }};
    const auto group = find_backend("replay")->make({{"thumb", {}, {}}}, context);
    std::vector<Reading> readings(1);
    group->activate();
    group->read(Time(0), readings);
    EXPECT_TRUE(readings[0].status & kNoMoreData);
}

TEST(Replay, NeedsARecording) {
    EXPECT_THROW(find_backend("replay")->make({{"thumb", {}, {}}}, {}), Error);
}

}  // namespace
}  // namespace dihaptic::devices::conformance_test
