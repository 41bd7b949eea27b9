// Tests ticks that are late again and again, in the complete servo: the force on the hand while the
// coupling is softened, and that force ends when the loop allows no useful stiffness.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "devices/forcedimension/dhd.h"
#include "devices/openhaptics/hd.h"
#include "devices/test/fakes.h"
#include "haptics/late_loop.h"
#include "lift.h"
#include "planted_group.h"
#include "servo/run.h"
#include "testing/allocation_guard.h"

namespace dihaptic::servo::late_test {
namespace {

using std::chrono::milliseconds;

constexpr double kWanted = 1.5;  // force of each finger, with 300 N/m and 1000 N/m in series [N]
constexpr double kDepth = kWanted * (1 / 300.0 + 1 / 1000.0);  // depth of target after contact [m]

/// Thumb and index finger close on a block, or the thumb presses on a wall; both movements start 3
/// cm away and take 1 s.
struct Hold {
    hand::HandSpec hand;
    std::unique_ptr<hand::ScriptDriver> driver;
    std::unique_ptr<Servo> servo;
    Time now{0};
    double most = 0;    ///< largest force sent to any device [N]
    double last = 0;    ///< largest force sent to any device in the last tick [N]
    double before = 0;  ///< largest force in the last tick before the late ticks [N]
    uint32_t status = 0;
    double stiffness = 0;
    double softest = std::numeric_limits<double>::infinity();

    enum class What { wall, block };
    /// `backend` is "real" or "simulated" for simulated devices that count as real or as simulated,
    /// or the name of a manufacturer's backend.
    explicit Hold(What what, const std::string& backend = "real", frame::Settings settings = {}) {
        scene::Scene scene = block_on_table();
        constexpr double kTouch = 0.0225;  // x of a pad's centre when it touches
        constexpr double kOff = 0.03;
        hand.centre = {0, 0, 0.02};
        hand.aperture = 2 * (kTouch + kOff);
        hand.script = {{"close", 1, 2 * (kTouch - kDepth), Vec3::Zero(), false},
                       {"stay", 30, {}, Vec3::Zero(), false}};
        if (what == What::wall) {
            scene.bodies[1].fixed = true;
            scene.fingers.resize(1);
            hand.centre.x() = -kTouch - kOff;
            hand.script[0] = {"press", 1, {}, {kOff + kDepth, 0, 0}, false};
        }
        for (scene::Finger& finger : scene.fingers) {
            finger.shape = scene::Shape::box({0.005, 0.02, 0.02});
            finger.mass = 0.001;
        }
        const auto fingers = scene::finger_names(scene);
        driver = std::make_unique<hand::ScriptDriver>(hand, fingers);
        devices::Context context;
        context.driver = driver.get();
        context.impedance = hand.impedance;
        const rig::Rig rig = rig::simulated_rig(fingers);
        std::unique_ptr<devices::DeviceGroup> group;
        if (backend == "real" || backend == "simulated") {
            group = std::make_unique<PlantedGroup>(rig::make_devices(rig, fingers, context),
                                                   backend == "simulated");
        } else {
            std::vector<devices::DeviceConfig> configs;
            for (const std::string& finger : fingers) configs.push_back({finger, {}, {}});
            group = devices::make_behind(backend,
                                         std::vector<devices::simulated::Options>(fingers.size()),
                                         configs, context);
            devices::Hand& plant = backend == "openhaptics"
                                       ? devices::openhaptics::fake_hd_as_it_is().hand
                                       : devices::forcedimension::fake_dhd_as_it_is().hand;
            // driven by the servo's time instead of advancing one period per tick
            plant = [this, inner = plant](size_t i, double, const Wrench& acting) {
                return inner(i, seconds(now), acting);
            };
        }
        servo =
            std::make_unique<Servo>(scene, settings, std::move(group), rig::poses(rig, fingers));
        servo->activate();
    }

    void tick() {
        const frame::Frame& frame = servo->tick(now, {});
        last = 0;
        for (const frame::FingerFrame& finger : frame.fingers)
            last = std::max(last, finger.f_sent_W.norm());
        most = std::max(most, last);
        status |= frame.status;
        stiffness = frame.stiffness;
        softest = std::min(softest, stiffness);
    }
    /// Runs ticks until `end`, one millisecond apart until `from` and `apart` from then on. If the
    /// devices pace the run, they call the ticks. `each` is called after each tick.
    void run(Time from, Time apart, Time end, const std::function<void()>& each = {}) {
        const auto next = [&] {
            if (now < from) before = last;
            tick();
            if (each) each();
            now += now < from ? milliseconds(1) : apart;
            return now <= end && !servo->stopped();
        };
        if (servo->devices().paces()) {
            servo->pace(next);
        } else {
            while (next()) {
            }
        }
    }
};

struct Case {
    const char* backend;
    Hold::What what;
    int late;  ///< how late each tick is [ms]
    int from;  ///< when the late ticks start [ms]
};
void PrintTo(const Case& c, std::ostream* out) {
    *out << c.backend << (c.what == Hold::What::wall ? " wall " : " block ") << c.late
         << " ms from " << c.from;
}
class KeepsLate : public ::testing::TestWithParam<Case> {};

TEST_P(KeepsLate, NeverPushesHarderThanWantedAndEndsWhereNothingIsHeld) {
    const Case& of = GetParam();
    Hold hold(of.what, of.backend);
    hold.run(milliseconds(of.from), milliseconds(1 + of.late), milliseconds(of.from + 4000));
    const double held = haptics::held_stiffness(hold.servo->damping(), of.late * 1e-3);
    fmt::print(
        "{:14s} {:5s} late by {:2d} ms from {:4d} ms: most {:.2f} N, then {:.2f} N at {:4.0f} "
        "N/m{}\n",
        of.backend, of.what == Hold::What::wall ? "wall" : "block", of.late, of.from, hold.most,
        hold.last, hold.stiffness,
        hold.servo->fault() ? fmt::format(", ended after {:.2f} s",
                                          seconds(hold.servo->fault().time) - of.from * 1e-3)
                            : "");
    EXPECT_LE(hold.most, 1.2 * kWanted);
    if (of.from > 1500) {
        EXPECT_NEAR(hold.before, kWanted, 0.02);
    }
    if (held < haptics::kLeastHeld) {
        ASSERT_EQ(hold.servo->fault().kind, haptics::FaultKind::keeps_late);
        EXPECT_EQ(hold.servo->fault().limit, haptics::kLeastHeld);
        EXPECT_LE(hold.servo->fault().value, (1 + of.late) * 1e-3);
        EXPECT_NE(hold.status & kKeepsLate, 0u);
        EXPECT_EQ(hold.last, 0);
        return;
    }
    EXPECT_FALSE(hold.servo->fault());
    EXPECT_NEAR(hold.stiffness, std::min(1000.0, held), 0.02 * held);
    if (held < 1000) {
        EXPECT_NE(hold.status & kSoftened, 0u);
    }
    // the remaining grip: the same target, but a softer spring
    const double k = hold.stiffness;
    EXPECT_NEAR(hold.last, kDepth * 300 * k / (300 + k), 0.03);
}

std::vector<Case> cases() {
    std::vector<Case> out;
    for (const char* backend : {"real", "openhaptics", "forcedimension"}) {
        for (const Hold::What what : {Hold::What::wall, Hold::What::block}) {
            for (const int late : {2, 5, 10, 20, 38}) {
                // late while the block is held, while the hand is closing, and from the start
                for (const int from : {2000, 750, 0}) out.push_back({backend, what, late, from});
            }
        }
    }
    return out;
}
INSTANTIATE_TEST_SUITE_P(Servo, KeepsLate, ::testing::ValuesIn(cases()));

using What = Hold::What;
constexpr Time kHeld = milliseconds(2000);  // the hand has come to rest long before

TEST(Late, NoneChangesABit) {
    // ticks exactly one period apart, with devices that count as real and as simulated
    Hold real(What::block);
    Hold simulated(What::block, "simulated");
    for (int i = 0; i < 2000; ++i, real.now += milliseconds(1), simulated.now += milliseconds(1)) {
        real.tick();
        simulated.tick();
        ASSERT_EQ(real.last, simulated.last) << i;
    }
    EXPECT_EQ(real.softest, 1000);
    EXPECT_EQ(real.status & kSoftened, 0u);
}

TEST(Late, ASinglePauseIsNotFelt) {
    for (const int pause : {10, 39}) {
        Hold hold(What::wall);
        double least = kWanted;
        const auto look = [&] {
            if (hold.now >= kHeld) least = std::min(least, hold.last);
        };
        hold.run(kHeld, milliseconds(1), kHeld, look);
        hold.now += milliseconds(pause);
        hold.run(Time(0), milliseconds(1), hold.now + milliseconds(1000), look);
        EXPECT_EQ(hold.softest, 1000);
        EXPECT_GT(least, 0.99 * kWanted) << pause;
        EXPECT_LT(hold.most, 1.01 * kWanted) << pause;
        EXPECT_FALSE(hold.servo->fault());
    }
}

TEST(Late, TheCouplingComesBackWithoutAStepInForce) {
    Hold hold(What::wall);
    hold.run(kHeld, milliseconds(11), kHeld + milliseconds(3000));
    EXPECT_LT(hold.stiffness, 430);
    double last = hold.last;
    double step = 0;
    hold.run(Time(0), milliseconds(1), hold.now + milliseconds(3000), [&] {
        step = std::max(step, std::abs(hold.last - last));
        last = hold.last;
    });
    EXPECT_EQ(hold.stiffness, 1000);
    EXPECT_NEAR(hold.last, kWanted, 1e-3);
    EXPECT_LT(step, 0.02);
    EXPECT_LT(hold.most, 1.1 * kWanted);
    EXPECT_EQ(hold.servo->tick(hold.now, {}).status & kSoftened, 0u);
}

TEST(Late, AReplayThatAsksForWhatWasInForceIsTheSame) {
    // holds if the replay's ticks have the same times
    frame::Settings settings;
    settings.coupling.damping = 2;
    Hold hold(What::block, "real", settings);
    Hold replay(What::block, "real", settings);
    double softest = 1000;
    Time now{0};
    for (int i = 0; i < 2500; ++i) {
        // ticks are on time, then alternately late and on time, all late, and on time again
        now += milliseconds(i < 500 ? 1 : i < 900 ? 1 + 12 * (i % 2) : i < 1200 ? 13 : 1);
        const frame::Frame& frame = hold.servo->tick(now, {});
        const frame::Knobs in_force = frame;
        const frame::Frame& again =
            replay.servo->tick(now, [&](const frame::Frame&, std::span<const frame::Handle>,
                                        frame::Commands& commands) { commands.knobs = in_force; });
        ASSERT_EQ(again.fingers[0].f_sent_W, frame.fingers[0].f_sent_W) << i;
        ASSERT_EQ(again.stiffness, frame.stiffness) << i;
        ASSERT_EQ(again.damping, frame.damping) << i;
        softest = std::min(softest, frame.stiffness);
    }
    EXPECT_LT(softest, 500);
    EXPECT_EQ(hold.servo->tick(now + milliseconds(1), {}).stiffness, 1000);
}

TEST(Late, AllocatesNothing) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Hold hold(What::block);
    hold.run(milliseconds(100), milliseconds(1), milliseconds(100));
    const testing::AllocationGuard guard;
    for (int i = 0; i < 300; ++i, hold.now += milliseconds(11)) hold.tick();
    EXPECT_EQ(guard.count(), 0u);
    EXPECT_NE(hold.status & kSoftened, 0u);
}

TEST(Late, OnSimulatedDevicesIsToldAndNoFault) {
    Hold hold(What::wall, "simulated");
    hold.run(kHeld, milliseconds(70), kHeld + milliseconds(3000));
    EXPECT_FALSE(hold.servo->fault());
    EXPECT_FALSE(hold.servo->real());
    EXPECT_EQ(hold.softest, 1000);
    EXPECT_NE(hold.status & kLate, 0u);
    EXPECT_EQ(hold.status & (kForceOff | kSoftened), 0u);
    // lateness below max_pause is not a fault, either
    frame::Settings settings;
    settings.safety.hand_damping = 1;
    Hold often(What::wall, "simulated", settings);
    often.run(kHeld, milliseconds(39), kHeld + milliseconds(3000));
    EXPECT_FALSE(often.servo->fault());
    EXPECT_EQ(often.softest, 1000);
    EXPECT_NE(often.status & kKeepsLate, 0u);
    EXPECT_EQ(often.status & (kLate | kForceOff), 0u);
}

TEST(Late, MoreThanMaxLateEndsForceInTheNextTick) {
    frame::Settings settings;
    settings.safety.max_late = 3e-3;
    Hold hold(What::wall, "real", settings);
    hold.run(kHeld, milliseconds(1), kHeld);
    hold.now += milliseconds(3);  // in addition to the 1 ms added by run()
    hold.tick();
    EXPECT_FALSE(hold.servo->fault());
    EXPECT_GT(hold.last, 1);
    hold.now += milliseconds(5);
    hold.tick();
    EXPECT_EQ(hold.last, 0);
    EXPECT_EQ(hold.servo->fault().kind, haptics::FaultKind::late);
    EXPECT_NEAR(hold.servo->fault().value, 4e-3, 1e-9);
    EXPECT_EQ(hold.servo->fault().limit, 3e-3);
    // a tick that wakes up late, but whose time is the time when it was due
    Hold woken(What::wall, "real", settings);
    woken.run(kHeld, milliseconds(1), kHeld);
    woken.servo->note_timing({2.9e-3, 1e-5, false});
    woken.tick();
    EXPECT_FALSE(woken.servo->fault());
    woken.now += milliseconds(1);
    woken.servo->note_timing({3.1e-3, 1e-5, false});
    woken.tick();
    EXPECT_EQ(woken.last, 0);
    EXPECT_EQ(woken.servo->fault().value, 3.1e-3);
}

TEST(Late, ASessionThatGoesOnAfterItBeginsAnew) {
    frame::Settings settings;
    settings.safety.hand_damping = 1;
    Hold hold(What::wall, "real", settings);
    hold.run(kHeld, milliseconds(21), kHeld + milliseconds(3000));
    ASSERT_EQ(hold.servo->fault().kind, haptics::FaultKind::keeps_late);
    hold.servo->resume();
    hold.run(Time(0), milliseconds(1), hold.now + milliseconds(2000));
    EXPECT_FALSE(hold.servo->fault());
    EXPECT_NEAR(hold.last, kWanted, 0.01);
}

}  // namespace
}  // namespace dihaptic::servo::late_test
