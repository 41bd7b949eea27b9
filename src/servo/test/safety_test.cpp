// Tests each safety rule in the complete servo: what triggers the rule, and the force on the hand
// afterwards.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/number.h"
#include "lift.h"
#include "planted_group.h"
#include "servo/run.h"
#include "testing/allocation_guard.h"

namespace dihaptic::servo::safety_test {
namespace {

struct Session {
    std::unique_ptr<hand::ScriptDriver> driver;
    PlantedGroup* devices = nullptr;
    std::unique_ptr<Servo> servo;
    uint32_t buttons = 0;  ///< buttons of the first device
    int next = 0;

    Session(const scene::Scene& scene, const hand::HandSpec& hand, const frame::Settings& settings,
            const std::string& options = "") {
        const auto fingers = scene::finger_names(scene);
        driver = std::make_unique<hand::ScriptDriver>(hand, fingers);
        rig::Rig rig = rig::simulated_rig(fingers);
        for (rig::Device& device : rig.devices)
            if (!options.empty()) device.options = parse_yaml(options, "rig.yaml");
        devices::Context context;
        context.driver = driver.get();
        context.impedance = hand.impedance;
        context.tremor = hand.tremor;
        auto group = std::make_unique<PlantedGroup>(rig::make_devices(rig, fingers, context), true);
        devices = group.get();
        devices->plant = [this](std::span<devices::Reading> readings) {
            readings[0].buttons = buttons;
        };
        servo =
            std::make_unique<Servo>(scene, settings, std::move(group), rig::poses(rig, fingers));
        servo->activate();
    }
    const frame::Frame& tick(const frame::Director& director = {}) {
        return servo->tick(next++ * std::chrono::milliseconds(1), director);
    }
};

/// Returns a scene with one finger and a wall that fills all of space beyond x = 0.
/// pressing_hand(start, end) moves the face of the finger's pad from `start` to `end` in 0.4 s.
scene::Scene wall() {
    scene::Scene out;
    scene::Body wall;
    wall.name = "wall";
    wall.shape = scene::Shape::box({0.2, 0.5, 0.5});
    wall.position = {0.1, 0, 0};
    wall.fixed = true;
    out.bodies = {wall};
    scene::Finger finger;
    finger.name = "thumb";
    finger.shape = scene::Shape::box({0.005, 0.02, 0.02});
    finger.mass = 0.001;
    out.fingers = {finger};
    return out;
}
hand::HandSpec pressing_hand(double start, double end) {
    hand::HandSpec out;
    out.centre = {start - 0.0025, 0, 0};
    out.script = {{"press", 0.4, {}, {end - start, 0, 0}, false},
                  {"stay", 10, {}, Vec3::Zero(), false}};
    return out;
}

TEST(Safety, AForceHeldTooLongFallsToTheContinuousOneSmoothly) {
    frame::Settings settings;
    settings.safety.heating_time = 1;
    // 10 mm through springs of 300 and 1000 N/m in series give 2.3 N, which then falls to 1.4 N
    Session session(wall(), pressing_hand(-0.01, 0.01), settings,
                    "continuous_force_N: 1.4\nworkspace_mm: [500, 500, 500]\n");
    uint32_t status = 0;
    double peak = 0, last = 0;
    for (int i = 0; i < 3000; ++i) {
        const frame::Frame& frame = session.tick();
        const double force = frame.fingers[0].f_sent_W.norm();
        peak = std::max(peak, force);
        // force must not be cut abruptly: (f^2 - f_c^2) f_p^2 / (2 f f_c^2 tau) is 27 N/s at 2.3 N
        if (i > 400) {
            EXPECT_LT(std::abs(force - last), 0.03) << i;
        }
        last = force;
        status |= frame.status;
    }
    EXPECT_GT(peak, 2);
    EXPECT_NEAR(last, 1.4, 0.01);
    EXPECT_EQ(status, unsigned{kHeatLimited});
    EXPECT_FALSE(session.servo->fault());
}

TEST(Safety, AHandThatLeavesTheWorkspaceIsPushedBack) {
    scene::Scene scene = wall();
    scene.bodies[0].position.x() += 10;
    // the box ends at x = 50 mm; the hand's target is 30 mm further, shared by springs of 300 and
    // 500 N/m
    Session session(scene, pressing_hand(0.0025, 0.0825), {}, "workspace_mm: [100, 500, 500]\n");
    const frame::Frame* frame = nullptr;
    for (int i = 0; i < 1500; ++i) {
        frame = &session.tick();
        const frame::FingerFrame& finger = frame->fingers[0];
        const bool outside = finger.p_WH.x() > 0.05;
        EXPECT_EQ((frame->status & kPushedInward) != 0, outside) << i;
        EXPECT_LE(finger.f_sent_W.x(), 0);
        if (!outside) {
            EXPECT_EQ(finger.f_sent_W, Vec3::Zero());
        }
    }
    const double depth = 0.03 * 300 / 800;
    EXPECT_NEAR(frame->fingers[0].p_WH.x(), 0.05 + depth, 1e-5);
    EXPECT_NEAR(frame->fingers[0].f_sent_W.x(), -500 * depth, 1e-2);
}

/// Returns the largest speed of a hand that starts 5 mm inside a wall and is thrown out [m/s].
double thrown_at(double soft_start, uint32_t& status) {
    frame::Settings settings;
    settings.safety.soft_start = soft_start;
    Session session(wall(), pressing_hand(0.005, 0.005), settings);
    double speed = 0;
    for (int i = 0; i < 1000; ++i) {
        const frame::Frame& frame = session.tick();
        if (i == 0 && soft_start > 0) {
            EXPECT_EQ(session.devices->told[0].force, Vec3::Zero());
        }
        speed = std::max(speed, frame.fingers[0].v_WH.norm());
        status |= frame.status;
    }
    return speed;
}

TEST(Safety, AHandThatBeginsInsideAWallIsNotThrownOut) {
    uint32_t soft = 0, hard = 0;
    const double thrown = thrown_at(0, hard);
    const double eased = thrown_at(frame::Settings{}.safety.soft_start, soft);
    EXPECT_GT(thrown, 0.2);
    EXPECT_LT(eased, 0.05);
    EXPECT_EQ(hard & kSoftStarted, 0u);
    EXPECT_NE(soft & kSoftStarted, 0u);
}

TEST(Safety, AHandThatTouchesLaterFeelsTheSameWithASoftStart) {
    frame::Settings none;
    none.safety.soft_start = 0;
    Session with(wall(), pressing_hand(-0.002, 0.01), {});
    Session without(wall(), pressing_hand(-0.002, 0.01), none);
    for (int i = 0; i < 400; ++i) {
        const Vec3 force = with.tick().fingers[0].f_sent_W;
        ASSERT_EQ(force, without.tick().fingers[0].f_sent_W) << i;
    }
}

TEST(Safety, ForceIsOnOnlyWhileTheDeadManSwitchIsHeld) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    frame::Settings settings;
    settings.safety.dead_man_finger = "thumb";
    settings.safety.dead_man_button = 2;
    Session session(block_on_table(), lifting_hand(), settings);
    const testing::AllocationGuard guard;
    Vec3 last = Vec3::Zero();
    for (int i = 0; i < 1200; ++i) {
        const bool held = i < 500 || i >= 600;
        session.buttons = held ? 0b101 : 0b001;
        const frame::Frame& frame = session.tick();
        const Vec3& force = session.devices->told[0].force;
        if (!held) {
            ASSERT_EQ(session.devices->largest_told(), 0) << i;
            ASSERT_NE(frame.status & kSwitchedOff, 0u);
        } else {
            ASSERT_EQ(frame.status & kSwitchedOff, 0u);
        }
        if (i == 499) {
            ASSERT_GT(force.norm(), 0.5);
        }
        if (i >= 600 && i < 1000) {  // rises from zero by 1/500 of the force per tick
            const double share = (i - 600) / 500.0;
            ASSERT_NEAR((force - share * frame.fingers[0].f_asked_W).norm(), 0, 1e-9) << i;
            ASSERT_NE(frame.status & kSoftStarted, 0u) << i;
        }
        last = force;
    }
    EXPECT_GT(last.norm(), 0.5);
    EXPECT_EQ(guard.count(), 0u);
}

TEST(Safety, ASwitchOfAFingerThatIsNotThereIsHeldByNobody) {
    frame::Settings settings;
    settings.safety.dead_man_finger = "toe";
    Session session(block_on_table(), lifting_hand(), settings);
    session.buttons = ~0u;
    for (int i = 0; i < 500; ++i) {
        ASSERT_NE(session.tick().status & kSwitchedOff, 0u);
        ASSERT_EQ(session.devices->told[0].force, Vec3::Zero());
    }
}

TEST(Safety, TheOperatorSwitchesForceOffAtOnceAndEndsTheRun) {
    Session session(block_on_table(), lifting_hand(), {});
    for (int i = 0; i < 500; ++i) session.tick();
    EXPECT_GT(session.devices->told[0].force.norm(), 0.5);
    EXPECT_FALSE(session.servo->stopped());
    const frame::Frame& frame =
        session.tick([](const frame::Frame&, std::span<const frame::Handle>,
                        frame::Commands& commands) { commands.force_off = true; });
    EXPECT_EQ(session.devices->largest_told(), 0);
    EXPECT_EQ(frame.status, unsigned{kStopped} | kForceOff);
    EXPECT_EQ(session.servo->fault().kind, haptics::FaultKind::stopped);
    EXPECT_TRUE(session.servo->stopped());
}

TEST(Safety, AFaultEndsTheRunASecondLater) {
    frame::Settings settings;
    settings.safety.max_speed = 0.05;
    Session session(block_on_table(), lifting_hand(), settings);
    const std::atomic<bool> stop{false};
    const Time end = run_virtual(*session.servo, {}, {}, std::chrono::seconds(10), stop);
    ASSERT_EQ(session.servo->fault().kind, haptics::FaultKind::too_fast);
    EXPECT_EQ(end, session.servo->fault().time + kGrace);
}

// ---- energy guard -----------------------------------------------------------------------------

/// Returns a hand that grips, lifts, tosses and catches a block, and pushes it along the table.
hand::HandSpec busy_hand() {
    hand::HandSpec out;
    out.centre = {0, 0, 0.02};
    out.aperture = 0.06;
    out.tremor = {0.1e-3, 8, 9};
    out.script = {
        {"close", 0.3, 0.025, Vec3::Zero(), false},  {"lift", 0.4, {}, {0, 0, 0.1}, false},
        {"shake", 0.15, {}, {0.06, 0, 0}, false},    {"and back", 0.15, {}, {-0.06, 0, 0}, false},
        {"throw", 0.15, {}, {0, 0, 0.08}, false},    {"let go", 0.05, 0.06, {0, 0, 0.02}, false},
        {"catch", 0.08, 0.03, Vec3::Zero(), false},  {"lower", 0.4, {}, {0, 0, -0.2}, false},
        {"release", 0.2, 0.08, Vec3::Zero(), false}, {"push", 0.3, {}, {0.1, 0, 0}, false},
        {"push back", 0.2, {}, {-0.1, 0, 0}, false}, {"slap", 0.1, 0.03, Vec3::Zero(), false},
        {"open", 0.1, 0.1, Vec3::Zero(), false}};
    return out;
}

struct Energy {
    double most = 0;  ///< largest energy generated by any finger [J]
    uint32_t status = 0;
    double most_force = 0;  ///< largest force requested [N]
};

Energy observe(const scene::Scene& scene, const hand::HandSpec& hand,
               const frame::Settings& settings, const std::string& options = "") {
    Session session(scene, hand, settings, options);
    Energy out;
    const auto ticks = static_cast<int>(session.driver->duration() * 1e3);
    for (int i = 0; i < ticks; ++i) {
        const frame::Frame& frame = session.tick();
        out.status |= frame.status;
        for (size_t f = 0; f < frame.fingers.size(); ++f) {
            const frame::FingerFrame& finger = frame.fingers[f];
            out.most = std::max(out.most, session.servo->generated(static_cast<int>(f)));
            out.most_force = std::max(out.most_force, finger.f_asked_W.norm());
        }
    }
    return out;
}

struct Rendering {
    const char* name;
    scene::ProxyKind proxy;
    double stiffness;
    const char* options;
    frame::PointFriction friction = frame::PointFriction::together;
};
void PrintTo(const Rendering& rendering, std::ostream* out) {
    *out << rendering.name;
}
class SoundCoupling : public ::testing::TestWithParam<Rendering> {
  protected:
    frame::Settings settings() const {
        frame::Settings out;
        out.proxy.kind = GetParam().proxy;
        out.proxy.friction = GetParam().friction;
        out.coupling.stiffness = GetParam().stiffness;
        return out;
    }
};

TEST_P(SoundCoupling, GivesNobodyEnergyInGraspLiftTossPushAndSlap) {
    const Energy energy = observe(block_on_table(), busy_hand(), settings(), GetParam().options);
    EXPECT_EQ(energy.status & kEnergyGenerated, 0u);
    RecordProperty("generated_mJ", number_text(energy.most * 1e3));
    EXPECT_LT(energy.most, haptics::kEnergyBudget / 2);
    EXPECT_GT(energy.most_force, 1);
}

TEST_P(SoundCoupling, IsSeenWhenItsDampingTurnsNegative) {
    frame::Settings active = settings();
    active.coupling.damping = -5;
    // an apart point has only the mass h c + h^2 k in the step, which a negative damper takes away
    active.proxy.friction = frame::PointFriction::apart;
    // fingers heavy enough for the implicit coupling: m + h c + h^2 k stays positive
    scene::Scene scene = block_on_table();
    for (scene::Finger& finger : scene.fingers) finger.mass = 0.06;
    const Energy energy = observe(scene, busy_hand(), active, GetParam().options);
    EXPECT_NE(energy.status & kEnergyGenerated, 0u);
    EXPECT_EQ(energy.status & kEnergyDamped, 0u);
}

constexpr const char* kPremium = "position_step_mm: 0.03\nfriction_N: 0.04\n";
INSTANTIATE_TEST_SUITE_P(
    EnergyGuard, SoundCoupling,
    ::testing::Values(Rendering{"rigid 300", scene::ProxyKind::rigid, 300, ""},
                      Rendering{"rigid 1000", scene::ProxyKind::rigid, 1000, ""},
                      Rendering{"rigid 3000", scene::ProxyKind::rigid, 3000, ""},
                      Rendering{"rigid 1000, premium", scene::ProxyKind::rigid, 1000, kPremium},
                      Rendering{"point 300", scene::ProxyKind::point, 300, ""},
                      Rendering{"point 1000", scene::ProxyKind::point, 1000, ""},
                      Rendering{"point 1000, premium", scene::ProxyKind::point, 1000, kPremium},
                      Rendering{"point apart 300", scene::ProxyKind::point, 300, "",
                                frame::PointFriction::apart},
                      Rendering{"point apart 1000", scene::ProxyKind::point, 1000, "",
                                frame::PointFriction::apart},
                      Rendering{"point apart 1000, premium", scene::ProxyKind::point, 1000,
                                kPremium, frame::PointFriction::apart}));

TEST(EnergyGuard, TellsThatSlowDynamicsFindAFastHandLate) {
    // with steps of 10 ms, a grasp is calm; at 0.6 m/s, a wall is detected up to 6 mm late, and the
    // energy of this penetration is given back: at most k / 2 (6 mm)^2 = 36 mJ
    frame::Settings settings;
    settings.dynamics.every = 10;
    const Energy grasp = observe(block_on_table(), lifting_hand(), settings);
    EXPECT_EQ(grasp.status & kEnergyGenerated, 0u);
    settings.coupling.stiffness = 2000;
    double most = 0;
    for (int late = 0; late < 10; ++late) {  // ticks between a step of the world and the contact
        const double start = -0.06 - late * 0.6e-3;
        hand::HandSpec slap = pressing_hand(start, start);
        slap.script = {{"slap", 0.15, {}, {0.09, 0, 0}, true},
                       {"rest", 0.3, {}, Vec3::Zero(), false}};
        const Energy energy = observe(wall(), slap, settings);
        most = std::max(most, energy.most);
        EXPECT_EQ((energy.status & kEnergyGenerated) != 0, energy.most > haptics::kEnergyBudget);
    }
    EXPECT_GT(most, haptics::kEnergyBudget);
    EXPECT_LT(most, 0.036);
}

TEST(EnergyGuard, TamesACouplingThatWouldShakeTheHand) {
    // the hand has 3 N*s/m; with -5, the handle shakes more and more until it leaves the wall
    frame::Settings settings;
    settings.proxy.kind = scene::ProxyKind::point;
    settings.proxy.friction = frame::PointFriction::apart;
    settings.coupling.damping = -5;
    const auto shaking = [&](frame::EnergyGuardMode mode, uint32_t& status) {
        settings.safety.energy_guard = mode;
        Session session(wall(), pressing_hand(-0.01, 0.015), settings);
        double speed = 0;
        for (int i = 0; i < 2500; ++i) {
            const frame::Frame& frame = session.tick();
            status |= frame.status;
            if (i > 2000) speed = std::max(speed, frame.fingers[0].v_WH.norm());
        }
        return speed;
    };
    uint32_t warned = 0, acted = 0;
    const double shakes = shaking(frame::EnergyGuardMode::warn, warned);
    const double tamed = shaking(frame::EnergyGuardMode::act, acted);
    EXPECT_GT(shakes, 0.2);
    EXPECT_LT(tamed, shakes / 3);
    EXPECT_NE(warned & kEnergyGenerated, 0u);
    EXPECT_EQ(warned & kEnergyDamped, 0u);
    EXPECT_NE(acted & kEnergyDamped, 0u);
}

}  // namespace
}  // namespace dihaptic::servo::safety_test
