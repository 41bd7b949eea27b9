// Tests devices that measure orientation and render torque: how the tick uses them, and that every
// safety rule for force also applies to torque.
#include <gtest/gtest.h>

#include "planted_group.h"
#include "rig/rig.h"
#include "servo/servo.h"
#include "testing/allocation_guard.h"
#include "turning_bar.h"

namespace dihaptic::servo::orientation_test {
namespace {

/// A session with turning_bar() and simulated devices.
struct Session {
    std::unique_ptr<hand::ScriptDriver> driver;
    PlantedGroup* device = nullptr;
    std::function<void(devices::Reading&)> spoil;
    uint32_t buttons = 1;
    std::unique_ptr<Servo> servo;
    int next = 0;

    explicit Session(double turn, const frame::Settings& settings = {},
                     const std::string& options = "{orientation: yes, peak_torque_Nm: 1}",
                     const Vec3& rotation = Vec3::Zero()) {
        driver = std::make_unique<hand::ScriptDriver>(turning_hand(turn),
                                                      std::vector<std::string>{"hand"});
        rig::Rig rig = rig::simulated_rig({"hand"});
        rig.devices[0].options = parse_yaml(options, "rig.yaml");
        rig.devices[0].rotation = rotation;
        devices::Context context;
        context.driver = driver.get();
        auto group =
            std::make_unique<PlantedGroup>(rig::make_devices(rig, {"hand"}, context), true);
        device = group.get();
        device->plant = [this](std::span<devices::Reading> readings) {
            readings[0].buttons = buttons;
            if (spoil) spoil(readings[0]);
        };
        servo = std::make_unique<Servo>(turning_bar(), settings, std::move(group),
                                        rig::poses(rig, {"hand"}));
        servo->activate();
    }
    const frame::Frame& tick() { return servo->tick(next++ * std::chrono::milliseconds(1), {}); }
    const frame::Frame& run(int ticks) {
        const frame::Frame* frame = nullptr;
        for (int i = 0; i < ticks; ++i) frame = &tick();
        return *frame;
    }
};

TEST(Orientation, AToolThatIsStoppedIsFeltAsATorqueWhereverTheDeviceStands) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    for (const Vec3& rotation : {Vec3(0, 0, 0), Vec3(1.2, -0.4, 2)}) {
        Session session(0.2, {}, "{orientation: yes, peak_torque_Nm: 1}", rotation);
        const testing::AllocationGuard guard;
        const frame::Frame& frame = session.run(1500);
        EXPECT_EQ(guard.count(), 0u);
        EXPECT_EQ(frame.status, 0u);
        const frame::TurnFrame& turn = frame.turns.at(0);
        // the hand's 1 N*m/rad and the coupling's 1 N*m/rad, in series, turned by 0.2 rad
        EXPECT_NEAR(turn.t_sent_W.y(), -0.1, 1e-4);
        EXPECT_EQ(turn.t_sent_W, turn.t_asked_W);
        EXPECT_LT((rotation_vector(turn.R_WH) - Vec3(0, 0.1, 0)).norm(), 1e-4);
        EXPECT_LT(angle_between(frame.fingers[0].R_WP, Quat::Identity()), 1e-4);
        const Quat R_WD = rotation_xyz(rotation);
        EXPECT_LT((R_WD * session.device->told[0].torque - turn.t_sent_W).norm(), 1e-12);
        EXPECT_LT((R_WD * rotation_vector(turn.R_DH) - rotation_vector(turn.R_WH)).norm(), 1e-9);
    }
}

TEST(Orientation, IsFollowedByToolsOfDevicesThatRenderNoTorque) {
    Session session(0.2, {}, "orientation: yes");
    const frame::Frame& frame = session.run(1500);
    EXPECT_EQ(frame.status, 0u);
    EXPECT_NEAR(frame.turns[0].t_asked_W.y(), -0.2, 1e-3);
    EXPECT_EQ(frame.turns[0].t_sent_W, Vec3::Zero());
    EXPECT_LT((rotation_vector(frame.turns[0].R_WH) - Vec3(0, 0.2, 0)).norm(), 1e-4);
}

TEST(Orientation, LeavesToolsOfOtherDevicesAsTheyAre) {
    Session session(0.2, {}, "{}");
    const frame::Frame& frame = session.run(600);
    EXPECT_TRUE(frame.turns.empty());
    EXPECT_EQ(frame.fingers[0].R_WP.coeffs(), Quat::Identity().coeffs());
    EXPECT_EQ(session.device->told[0].torque, Vec3::Zero());
}

TEST(Orientation, TorqueIsCutToTheDevicesPeakAndTheSetting) {
    frame::Settings settings;
    Session weak(0.4, settings, "{orientation: yes, peak_torque_Nm: 0.05}");
    const frame::Frame& frame = weak.run(1500);
    EXPECT_NE(frame.status & kForceLimited, 0u);
    EXPECT_NEAR(frame.turns[0].t_sent_W.norm(), 0.05, 1e-12);
    settings.safety.max_torque = 0.03;
    Session set(0.4, settings);
    EXPECT_NEAR(set.run(1500).turns[0].t_sent_W.norm(), 0.03, 1e-12);
}

TEST(Orientation, TorqueHeldTooLongFallsToTheContinuousOne) {
    frame::Settings settings;
    settings.safety.heating_time = 1;
    Session session(0.4, settings,
                    "{orientation: yes, peak_torque_Nm: 0.5, continuous_torque_Nm: 0.05}");
    double peak = 0;
    for (int i = 0; i < 6000; ++i) peak = std::max(peak, session.tick().turns[0].t_sent_W.norm());
    EXPECT_GT(peak, 0.1);
    EXPECT_NEAR(session.device->told[0].torque.norm(), 0.05, 1e-3);
}

TEST(Orientation, TorqueChangesNoFasterThanAllowed) {
    frame::Settings settings;
    settings.safety.max_torque_rate = 0.2;  // without the limit, torque would rise by 0.9 N*m/s
    Session session(0.2, settings);
    double last = 0;
    uint32_t status = 0;
    for (int i = 0; i < 1500; ++i) {
        const frame::Frame& frame = session.tick();
        const double now = frame.turns[0].t_sent_W.y();
        ASSERT_LE(std::abs(now - last), 0.2e-3 * (1 + 1e-9)) << i;
        last = now;
        status |= frame.status;
    }
    EXPECT_EQ(status, unsigned{kRateLimited});
    EXPECT_NEAR(last, -0.1, 1e-3);
}

TEST(Orientation, TorqueComesOnSoftlyAndGoesWithTheDeadManSwitch) {
    frame::Settings settings;
    settings.safety.dead_man_finger = "hand";
    Session session(0.2, settings);
    session.run(800);
    EXPECT_GT(session.device->told[0].torque.norm(), 0.05);
    session.buttons = 0;
    EXPECT_NE(session.tick().status & kSwitchedOff, 0u);
    EXPECT_TRUE(session.device->told[0].is_zero());
    session.buttons = 1;
    session.tick();
    const frame::Frame& frame = session.run(100);
    EXPECT_NE(frame.status & kSoftStarted, 0u);
    EXPECT_NEAR(frame.turns[0].t_sent_W.norm() / frame.turns[0].t_asked_W.norm(), 0.2, 1e-9);
}

TEST(Orientation, WhatCannotBeIsAFaultThatEndsTorqueAndForce) {
    struct Case {
        void (*spoil)(devices::Reading&);
        haptics::FaultKind kind;
        uint32_t status;
    };
    for (const Case& bad : {Case{[](devices::Reading& r) { r.R_DH.x() = kUnmeasured; },
                                 haptics::FaultKind::bad_reading, kBadReading},
                            Case{[](devices::Reading& r) { r.w_DH.z() = kUnmeasured; },
                                 haptics::FaultKind::bad_reading, kBadReading},
                            Case{[](devices::Reading& r) { r.R_DH.coeffs() *= 1.1; },
                                 haptics::FaultKind::bad_reading, kBadReading},
                            Case{[](devices::Reading& r) {
                                     r.R_DH = rotation_by({0.5, 0, 0}) * r.R_DH;
                                 },
                                 haptics::FaultKind::turned_too_fast, kTooFast},
                            Case{[](devices::Reading& r) {
                                     r.w_DH = {0, 200, 0};
                                 },
                                 haptics::FaultKind::turned_too_fast, kTooFast}}) {
        Session session(0.2);
        session.run(800);
        EXPECT_GT(session.device->told[0].torque.norm(), 0.05);
        session.spoil = bad.spoil;
        const frame::Frame& frame = session.tick();
        EXPECT_TRUE(session.device->told[0].is_zero());
        EXPECT_EQ(session.servo->fault().kind, bad.kind);
        EXPECT_NE(frame.status & bad.status, 0u);
        EXPECT_NE(frame.status & kForceOff, 0u);
        EXPECT_EQ(frame.turns[0].w_WH, Vec3::Zero());
        EXPECT_TRUE(frame.fingers[0].R_WP.coeffs().allFinite());
        session.run(100);
        EXPECT_TRUE(session.device->told[0].is_zero());
    }
}

TEST(Orientation, TheOperatorEndsTorqueToo) {
    Session session(0.2);
    session.run(800);
    session.servo->tick(std::chrono::milliseconds(session.next),
                        [](const frame::Frame&, std::span<const frame::Handle>,
                           frame::Commands& commands) { commands.force_off = true; });
    EXPECT_TRUE(session.device->told[0].is_zero());
}

TEST(Orientation, IsWatchedByTheEnergyGuard) {
    // a coupling that feeds the hand's oscillation instead of damping it, compared with a sound one
    frame::Settings settings;
    Session sound(0.3, settings);
    uint32_t status = 0;
    for (int i = 0; i < 3000; ++i) status |= sound.tick().status;
    EXPECT_EQ(status & kEnergyGenerated, 0u);
    settings.coupling.turn_damping = -0.03;
    settings.coupling.turn_stiffness = 1;
    settings.safety.max_force_rate = 1e9;
    settings.safety.max_torque_rate = 1e9;
    Session active(0.3, settings);
    for (int i = 0; i < 3000 && (status & kEnergyGenerated) == 0; ++i)
        status |= active.tick().status;
    EXPECT_NE(status & kEnergyGenerated, 0u);
}

}  // namespace
}  // namespace dihaptic::servo::orientation_test
