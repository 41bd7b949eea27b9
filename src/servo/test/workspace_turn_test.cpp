// Tests workspaces that turn about the vertical: readings and forces must turn with them, without
// jumps.
#include "servo/workspace_turn.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include "hand/script.h"
#include "lift.h"
#include "rig/rig.h"
#include "servo/servo.h"
#include "testing/allocation_guard.h"

namespace dihaptic::servo::workspace_turn_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTick = 1e-3;

double rate(const frame::Frame& last, double goal) {
    return WorkspaceTurn::rate_toward(goal, last.workspace_turn + kTick * last.workspace_rate);
}

/// Devices whose readings are set by the test, and which store the wrenches sent to them.
class Desk final : public devices::DeviceGroup {
  public:
    Desk(const std::vector<std::string>& fingers, bool orientation)
        : DeviceGroup(infos(fingers.size(), orientation)),
          readings(fingers.size()),
          told(fingers.size()) {}
    std::vector<devices::Reading> readings;
    std::vector<Wrench> told;

  private:
    static std::vector<frame::DeviceInfo> infos(size_t count, bool orientation) {
        frame::DeviceInfo info;
        info.model = "desk";
        info.peak_force = 20;
        info.workspace = Vec3(0.3, 0.2, 0.2);
        info.measures_orientation = orientation;
        info.peak_torque = orientation ? 1 : 0;
        return std::vector<frame::DeviceInfo>(count, info);
    }
    void do_activate() override {}
    void do_deactivate() override {}
    void do_read(Time, std::span<devices::Reading> out) noexcept override {
        std::copy(readings.begin(), readings.end(), out.begin());
    }
    void do_write(std::span<const Wrench> wrenches_D) noexcept override {
        std::copy(wrenches_D.begin(), wrenches_D.end(), told.begin());
    }
};

/// Two fingers in the air, with devices set up at an angle.
struct Air {
    scene::Scene scene;
    std::vector<Pose> X_WD;
    Desk* desk = nullptr;
    std::unique_ptr<Servo> servo;
    Time next{0};
    Time period = std::chrono::milliseconds(1);  ///< time between ticks; the servo's is 1 ms

    explicit Air(bool orientation = false, const frame::Settings& settings = {}) {
        for (const char* name : {"thumb", "index"}) {
            scene::Finger finger;
            finger.name = name;
            finger.shape = scene::Shape::box({0.005, 0.02, 0.02});
            scene.fingers.push_back(finger);
        }
        X_WD = {{rotation_xyz({0.5, 0.2, 1.1}), {-0.1, 0.1, 0.2}},
                {rotation_xyz({1.2, -0.4, 2}), {0.3, 0.05, 0.1}}};
        auto devices = std::make_unique<Desk>(scene::finger_names(scene), orientation);
        desk = devices.get();
        desk->readings[0].p_DH = {0.05, 0.02, -0.03};
        desk->readings[1].p_DH = {-0.06, 0.04, 0.02};
        servo = std::make_unique<Servo>(scene, settings, std::move(devices), X_WD);
        servo->activate();
    }
    const frame::Frame& tick(double goal, const Vec3& force_W = Vec3::Zero()) {
        next += period;
        return servo->tick(
            next - period, [&](const frame::Frame& last, std::span<const frame::Handle>,
                               frame::Commands& commands) {
                commands.knobs.workspace_rate = last.sequence < 0 ? 0 : rate(last, goal);
                add(commands.task.loads, {servo->world().scene_size(), force_W, Vec3::Zero()});
            });
    }
    /// Returns the mean of the devices' origins.
    Vec3 axis() const { return (X_WD[0].p + X_WD[1].p) / 2; }
};

Quat about_z(double angle) {
    return Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
}

TEST(WorkspaceTurn, StartsAndEndsWithoutAStepAndKeepsItsBounds) {
    for (const double goal : {kPi / 2, -0.3, 1e-3, 3.0, 5.0}) {
        WorkspaceTurn turn({Pose{}});
        double least = 0, most = 0, last = 0, fastest = 0;
        for (int i = 0; i < 8000; ++i) {
            turn.order(WorkspaceTurn::rate_toward(goal, turn.angle()), kTick);
            EXPECT_LE(std::abs(turn.rate() - last), 4e-3 * (1 + 1e-9)) << i;
            last = turn.rate();
            fastest = std::max(fastest, std::abs(last));
            turn.advance(kTick);
            least = std::min(least, turn.angle());
            most = std::max(most, turn.angle());
        }
        EXPECT_LE(fastest, 1);
        // the turn takes the shorter way, without overshoot
        const double way = goal > kPi ? goal - 2 * kPi : goal;
        EXPECT_NEAR(turn.angle(), way, 2e-6);
        EXPECT_LT(most - least, std::abs(way) * 1.005);
        EXPECT_EQ(turn.rate(), 0);
    }
}

TEST(WorkspaceTurn, EndsWithoutOvershootThoughEveryTickIsLate) {
    Air turning;
    turning.period = std::chrono::milliseconds(7);
    double most = 0;
    for (int i = 0; i < 600; ++i) most = std::max(most, turning.tick(kPi / 2).workspace_turn);
    EXPECT_LT(most, kPi / 2 * 1.005);
    EXPECT_NEAR(most, kPi / 2, 1e-3);
}

TEST(WorkspaceTurn, IsBoundedWhoeverOrdersIt) {
    WorkspaceTurn turn({Pose{}});
    turn.order(1000, kTick);
    EXPECT_NEAR(turn.rate(), 4e-3, 1e-15);
    for (int i = 0; i < 1000; ++i) turn.order(1000, kTick);
    EXPECT_EQ(turn.rate(), 1);
}

TEST(WorkspaceTurn, ReadingsTurnAboutTheDevicesMiddle) {
    // the rate of the turn that leads to a Frame is recorded in the previous Frame
    Air turning(true);
    double led = 0;
    std::vector<Vec3> before(2);
    std::vector<Quat> R_before(2);
    for (int i = 0; i < 900; ++i) {
        const double t = i * kTick;
        for (size_t d = 0; d < 2; ++d) {
            devices::Reading& reading = turning.desk->readings[d];
            reading.p_DH = Vec3(0.05 * std::sin(3 * t), 0.02, 0.03 * t);
            reading.v_DH = Vec3(0.15 * std::cos(3 * t), 0, 0.03);
            reading.R_DH = Quat(Eigen::AngleAxisd(0.4 * t, Vec3(1, 2, 2) / 3));
            reading.w_DH = 0.4 * Vec3(1, 2, 2) / 3;
        }
        const frame::Frame& frame = turning.tick(kPi / 2);
        const Quat T = about_z(frame.workspace_turn);
        for (size_t d = 0; d < 2; ++d) {
            const devices::Reading& reading = turning.desk->readings[d];
            const Pose& X_WD = turning.X_WD[d];
            const frame::FingerFrame& finger = frame.fingers[d];
            const Vec3 arm = T * (X_WD * reading.p_DH - turning.axis());
            ASSERT_LT((finger.p_WH - turning.axis() - arm).norm(), 1e-12);
            const Vec3 v = T * (X_WD.R * reading.v_DH) + Vec3(0, 0, led).cross(arm);
            ASSERT_LT((finger.v_WH - v).norm(), 1e-12);
            const Quat R = T * X_WD.R * reading.R_DH * X_WD.R.conjugate();
            ASSERT_LT(angle_between(frame.turns[d].R_WH, R), 1e-9);
            // both velocities belong to the movement that was observed
            if (i > 0) {
                ASSERT_LT(((finger.p_WH - before[d]) / kTick - finger.v_WH).norm(), 1.5e-3) << i;
                const Vec3 turned =
                    rotation_vector(frame.turns[d].R_WH * R_before[d].conjugate()) / kTick;
                ASSERT_LT((turned - frame.turns[d].w_WH).norm(), 1e-3) << i;
            }
            before[d] = finger.p_WH;
            R_before[d] = frame.turns[d].R_WH;
            ASSERT_EQ(finger.p_DH, reading.p_DH);  // as read
        }
        led = frame.workspace_rate;
    }
    EXPECT_GT(led, 0.99);
}

TEST(WorkspaceTurn, ForcesTurnBackAndGiveTheSamePowerInBothAxes) {
    frame::Settings settings;
    settings.safety.soft_start = 0;
    Air air(false, settings);
    air.desk->readings[0].v_DH = {0.1, -0.2, 0.3};
    const Vec3 force(1.5, -0.5, 2);
    double led = 0;
    for (int i = 0; i < 5000; ++i) {
        const frame::Frame& frame = air.tick(kPi / 2, force);
        const frame::FingerFrame& finger = frame.fingers[0];
        if (i > 10) {
            ASSERT_LT((finger.f_sent_W - force).norm(), 1e-12);
            const Quat R_WD = about_z(frame.workspace_turn) * air.X_WD[0].R;
            ASSERT_LT((R_WD * air.desk->told[0].force - force).norm(), 1e-12);
            const double by_device = air.desk->told[0].force.dot(finger.v_DH);
            const Vec3 carried = Vec3(0, 0, led).cross(finger.p_WH - air.axis());
            ASSERT_NEAR(finger.f_sent_W.dot(finger.v_WH - carried), by_device, 1e-12);
        }
        led = frame.workspace_rate;
    }
    // once the turn has stopped, the power is that of the full velocity
    EXPECT_EQ(led, 0);
    const frame::FingerFrame& finger = air.tick(kPi / 2, force).fingers[0];
    EXPECT_NEAR(finger.f_sent_W.dot(finger.v_WH), air.desk->told[0].force.dot(finger.v_DH), 1e-12);
}

TEST(WorkspaceTurn, TheWallStaysWithTheDevice) {
    frame::Settings settings;
    settings.safety.soft_start = 0;
    Air air(false, settings);
    air.desk->readings[0].p_DH = {0.152, 0, 0};  // 2 mm beyond the wall
    for (int i = 0; i < 4000; ++i) {
        const frame::Frame& frame = air.tick(2.5);
        if (i > 10) {
            // same as for a handle at rest, however the world turns around it
            EXPECT_LT((air.desk->told[0].force - Vec3(-1, 0, 0)).norm(), 1e-9) << i;
        }
        EXPECT_EQ(frame.fingers[0].status & kTooFast, 0u);
    }
    EXPECT_NEAR(air.servo->tick(air.next, {}).workspace_turn, 2.5, 1e-3);
}

TEST(WorkspaceTurn, ProxiesFollowInTheAirAndTurnWithoutALagOrAStep) {
    for (const auto kind : {frame::CouplingKind::implicit, frame::CouplingKind::dual_spring,
                            frame::CouplingKind::velocity_impulse}) {
        frame::Settings settings;
        settings.coupling.kind = kind;
        Air air(false, settings);
        Vec3 before = Vec3::Zero();
        for (int i = 0; i < 4000; ++i) {
            const frame::Frame& frame = air.tick(kPi / 2);
            const frame::FingerFrame& finger = frame.fingers[0];
            if (i > 0) {
                // the lag is at most the handle's movement in a step, plus the lag of a dual spring
                const double lag = kind == frame::CouplingKind::dual_spring ? 2e-3 : 0.3e-3;
                ASSERT_LT((finger.p_WP - finger.p_WH).norm(), lag) << enum_name(kind) << i;
                ASSERT_LT((finger.v_WP - before).norm(), 2e-3) << enum_name(kind) << i;
            }
            before = finger.v_WP;
            const Quat ahead = about_z(frame.workspace_turn + kTick * frame.workspace_rate);
            ASSERT_LT(angle_between(finger.R_WP, ahead), 1e-7) << i;
        }
        EXPECT_LT(angle_between(air.servo->tick(air.next, {}).fingers[0].R_WP, about_z(kPi / 2)),
                  1e-5);
    }
}

/// Two fingers that hold a block in the air.
struct Held {
    scene::Scene scene = block_on_table();
    std::unique_ptr<hand::ScriptDriver> driver;
    std::unique_ptr<Servo> servo;
    int next = 0;

    explicit Held(const frame::Settings& settings) {
        hand::HandSpec hand = lifting_hand();
        hand.script.push_back({"hold", 10, {}, Vec3::Zero(), false});
        const auto fingers = scene::finger_names(scene);
        driver = std::make_unique<hand::ScriptDriver>(hand, fingers);
        rig::Rig rig = rig::simulated_rig(fingers);
        for (rig::Device& device : rig.devices) {
            device.position = {0.02, -0.03, 0.07};
            device.rotation = {0.4, 0, 1};
        }
        devices::Context context;
        context.driver = driver.get();
        context.impedance = hand.impedance;
        servo = std::make_unique<Servo>(scene, settings, rig::make_devices(rig, fingers, context),
                                        rig::poses(rig, fingers));
        servo->activate();
    }
    const frame::Frame& tick(double goal) {
        return servo->tick(
            next++ * std::chrono::milliseconds(1),
            [&](const frame::Frame& last, std::span<const frame::Handle>,
                frame::Commands& commands) { commands.knobs.workspace_rate = rate(last, goal); });
    }
};

struct Holding {
    scene::ProxyKind proxy;
    frame::CouplingKind coupling;
};
class AnyHand : public ::testing::TestWithParam<Holding> {};
INSTANTIATE_TEST_SUITE_P(
    WorkspaceTurn, AnyHand,
    ::testing::Values(Holding{scene::ProxyKind::rigid, frame::CouplingKind::implicit},
                      Holding{scene::ProxyKind::rigid, frame::CouplingKind::dual_spring},
                      Holding{scene::ProxyKind::rigid, frame::CouplingKind::velocity_impulse},
                      Holding{scene::ProxyKind::point, frame::CouplingKind::implicit}),
    [](const auto& of) {
        return std::string(enum_name(of.param.proxy)) + "_" +
               std::string(enum_name(of.param.coupling));
    });

TEST_P(AnyHand, HoldsABlockWhileTheWorkspaceTurnsByARightAngle) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    frame::Settings settings;
    settings.proxy.kind = GetParam().proxy;
    settings.coupling.kind = GetParam().coupling;
    // stiffer couplings shake blocks loose with or without a turn
    if (settings.coupling.kind == frame::CouplingKind::dual_spring)
        settings.coupling.stiffness = 300;
    Held held(settings);
    for (int i = 0; i < 1300; ++i) held.tick(0);
    const Pose before = held.tick(0).bodies[1].X_WB;
    ASSERT_GT(before.p.z(), 0.06);
    const frame::Frame* frame = nullptr;
    std::vector<Vec3> last(2);
    double most = 0;
    uint32_t status = 0;
    const testing::AllocationGuard guard;
    for (int i = 0; i < 4000; ++i) {
        frame = &held.tick(kPi / 2);
        status |= frame->status;
        for (size_t d = 0; d < 2; ++d) {
            const Vec3 told =
                about_z(frame->workspace_turn).conjugate() * frame->fingers[d].f_sent_W;
            if (i > 0) most = std::max(most, (told - last[d]).norm());
            last[d] = told;
        }
        EXPECT_GT(frame->bodies[1].X_WB.p.z(), before.p.z() - 0.002);
    }
    EXPECT_EQ(guard.count(), 0u);
    EXPECT_NEAR(frame->workspace_turn, kPi / 2, 1e-5);
    EXPECT_EQ(status & ~uint32_t{kEnergyGenerated}, 0u);
    // the slew limit alone would permit 3 N
    EXPECT_LT(most, 2e-3);
    RecordProperty("most_change_N", number_text(most));
    const Pose after = frame->bodies[1].X_WB;
    const Vec3 c(0.02, -0.03, 0);
    const Vec3 arm = before.p - c;
    const Vec3 expected = c + Vec3(-arm.y(), arm.x(), arm.z());
    EXPECT_LT((after.p - expected).norm(), 1e-3);
    if (GetParam().proxy == scene::ProxyKind::rigid) {
        EXPECT_NEAR(angle_between(before.R, after.R), kPi / 2, 0.01);
    }
}

}  // namespace
}  // namespace dihaptic::servo::workspace_turn_test
