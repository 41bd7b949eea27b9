// Tests faults of real devices in the complete servo, using fakes of the manufacturers' libraries:
// no device may apply force in the tick that detects the fault, and the person must receive a
// message.
#include <gtest/gtest.h>

#include <thread>

#include "devices/forcedimension/dhd.h"
#include "devices/openhaptics/hd.h"
#include "devices/test/fakes.h"
#include "lift.h"
#include "servo/run.h"
#include "testing/sanitizer.h"

namespace dihaptic::servo::makers_faults_test {
namespace {

using devices::forcedimension::FakeDhd;
using devices::openhaptics::FakeHd;
using std::chrono::milliseconds;

constexpr int kTick = 500;  // tick of the fault, while the block is being lifted

/// Two fingers that close on a block within 0.3 s and lift it, using a manufacturer's library.
struct Grasp {
    hand::HandSpec hand = lifting_hand();
    std::unique_ptr<hand::ScriptDriver> driver;
    std::unique_ptr<Servo> servo;
    FakeHd* hd = nullptr;
    FakeDhd* dhd = nullptr;
    std::vector<std::string> models;

    explicit Grasp(const std::string& backend, const frame::Settings& settings = {}) {
        const scene::Scene scene = block_on_table();
        const auto fingers = scene::finger_names(scene);
        driver = std::make_unique<hand::ScriptDriver>(hand, fingers);
        devices::Context context;
        context.driver = driver.get();
        context.impedance = hand.impedance;
        auto group = devices::make_behind(backend, {{}, {}},
                                          {{fingers[0], {}, {}}, {fingers[1], {}, {}}}, context);
        if (backend == "openhaptics") hd = &devices::openhaptics::fake_hd_as_it_is();
        if (backend == "forcedimension") dhd = &devices::forcedimension::fake_dhd_as_it_is();
        for (int i = 0; i < group->size(); ++i) models.push_back(group->info(i).model);
        servo = std::make_unique<Servo>(scene, settings, std::move(group),
                                        rig::poses(rig::simulated_rig(fingers), fingers));
        servo->activate();
    }
    /// Returns the present force on a finger [N].
    double acting(size_t device) const {
        return hd != nullptr ? hd->devices[device].acting.norm()
                             : dhd->devices[device].acting.norm();
    }
    std::string told() const {
        const haptics::Fault& fault = servo->fault();
        const auto device = static_cast<size_t>(std::max(0, fault.device));
        return haptics::describe(fault, device == 0 ? "thumb" : "index", models[device]) + " " +
               servo->devices().explain(static_cast<int>(device));
    }
};

struct Case {
    const char* name;
    const char* backend;
    void (*happen)(Grasp& grasp);
    haptics::FaultKind kind;
    Status status;
    const char* told;
};
void PrintTo(const Case& c, std::ostream* out) {
    *out << c.name;
}
class MakersFaults : public ::testing::TestWithParam<Case> {};

TEST_P(MakersFaults, TakeAllForceAwayInTheTickThatLearnsOfThem) {
    Grasp grasp(GetParam().backend);
    const std::atomic<bool> stop{false};
    int after = 0;
    run_virtual(
        *grasp.servo,
        [&](const frame::Frame& last, std::span<const frame::Handle>, frame::Commands&) {
            // the forces of the last tick are still acting
            if (last.sequence == kTick - 1) {
                EXPECT_GT(grasp.acting(0), 0.5);
                EXPECT_GT(grasp.acting(1), 0.5);
                GetParam().happen(grasp);
            }
            if (last.sequence <= kTick) return;
            EXPECT_EQ(grasp.acting(0), 0) << last.sequence;
            // a device that receives no requests is stopped only by its own watchdog
            const bool deaf = grasp.dhd != nullptr && grasp.dhd->devices[1].silent;
            if (deaf && last.sequence < kTick + 32) return;
            EXPECT_EQ(grasp.acting(1), 0) << last.sequence;
        },
        [&](const frame::Frame& frame) {
            for (const frame::FingerFrame& finger : frame.fingers) {
                ASSERT_TRUE(finger.p_WH.allFinite());
                ASSERT_TRUE(finger.f_sent_W.allFinite());
            }
            // the fault follows a reading, so the next reading detects it
            if (frame.sequence <= kTick) return;
            ++after;
            EXPECT_NE(frame.status & kForceOff, 0u) << frame.sequence;
            EXPECT_EQ(frame.fingers[0].f_sent_W, Vec3::Zero());
            EXPECT_EQ(frame.fingers[1].f_sent_W, Vec3::Zero());
            if (frame.sequence == kTick + 1) {
                EXPECT_NE(frame.status & GetParam().status, 0u);
            }
        },
        std::chrono::seconds(5), stop);
    EXPECT_NEAR(after, 1000, 2);  // kGrace
    EXPECT_EQ(grasp.servo->fault().kind, GetParam().kind);
    EXPECT_NE(grasp.told().find(GetParam().told), std::string::npos) << grasp.told();
}

using haptics::FaultKind;
INSTANTIATE_TEST_SUITE_P(
    Servo, MakersFaults,
    ::testing::Values(
        Case{"HD comm error", "openhaptics",
             [](Grasp& g) { g.hd->raise(devices::openhaptics::kHdCommError, 1); },
             FaultKind::not_answering, kNotAnswering,
             "the index's device (PHANToM Premium 1.0, serial 40124) does not answer. Check its "
             "power and its cables. HD_COMM_ERROR"},
        Case{"HD device fault", "openhaptics",
             [](Grasp& g) { g.hd->raise(devices::openhaptics::kHdDeviceFault, 0); },
             FaultKind::device_fault, kDeviceFault,
             "the thumb's device (PHANToM Premium 1.0, serial 40123) reports a fault of its own."},
        Case{"HD NaN", "openhaptics", [](Grasp& g) { g.hd->devices[1].nonsense = true; },
             FaultKind::bad_reading, kBadReading, "that is not a number. Check its cables"},
        Case{"HD silent", "openhaptics", [](Grasp& g) { g.hd->silent = true; },
             FaultKind::not_answering, kNotAnswering, "does not answer. Check its power"},
        Case{"DHD silent", "forcedimension", [](Grasp& g) { g.dhd->devices[1].silent = true; },
             FaultKind::not_answering, kNotAnswering,
             "the index's device (omega.3, serial 102) does not answer. Check its power and its "
             "cables. communication error."},
        Case{"DHD NaN", "forcedimension", [](Grasp& g) { g.dhd->devices[0].nonsense = true; },
             FaultKind::bad_reading, kBadReading, "that is not a number. Check its cables"},
        Case{"DHD uncalibrated", "forcedimension",
             [](Grasp& g) { g.dhd->devices[0].calibrated = false; }, FaultKind::uncalibrated,
             kUncalibrated, "lost its calibration. Calibrate it as its manual describes"},
        Case{"DHD broken", "forcedimension", [](Grasp& g) { g.dhd->devices[0].broken = true; },
             FaultKind::device_fault, kDeviceFault, "reports a fault of its own. Let it cool"}));

/// Tests a device that cuts its own force: the forces of the other devices must wait for it, and
/// all forces must return gently.
class ForceCut : public ::testing::TestWithParam<const char*> {};

TEST_P(ForceCut, LeavesNoHalfGraspAndComesBackSoftly) {
    Grasp grasp(GetParam());
    const std::atomic<bool> stop{false};
    double highest_soon = 0;
    double later = 0;
    uint32_t status = 0;
    run_virtual(
        *grasp.servo,
        [&](const frame::Frame& last, std::span<const frame::Handle>, frame::Commands&) {
            if (last.sequence != kTick - 1) return;
            if (grasp.hd != nullptr)
                grasp.hd->raise(devices::openhaptics::kHdExceededMaxVelocity, 1);
            if (grasp.dhd != nullptr) grasp.dhd->cut(1, devices::forcedimension::kDhdByVelocity);
        },
        [&](const frame::Frame& frame) {
            const double most =
                std::max(frame.fingers[0].f_sent_W.norm(), frame.fingers[1].f_sent_W.norm());
            if (frame.sequence == kTick + 1) {
                status = frame.status;
                EXPECT_EQ(most, 0);
            }
            // 5 % of the force after 5 % of the soft start of 0.5 s
            if (frame.sequence > kTick + 1 && frame.sequence < kTick + 25)
                highest_soon = std::max(highest_soon, most);
            if (frame.sequence == kTick + 800) later = most;
        },
        milliseconds(kTick + 900), stop);
    EXPECT_NE(status & kForceDropped, 0u);
    EXPECT_EQ(status & (kForceOff | kSwitchedOff), 0u);
    EXPECT_FALSE(grasp.servo->fault());
    EXPECT_LT(highest_soon, 0.3);
    EXPECT_GT(later, 1);
}
INSTANTIATE_TEST_SUITE_P(Servo, ForceCut, ::testing::Values("openhaptics", "forcedimension"));

/// Tests, in real time, a call that blocks in the middle of a tick.
class Late : public ::testing::TestWithParam<const char*> {
  protected:
    /// Runs for 0.7 s, during which a call of the second device blocks for `pause`.
    Timing run(Grasp& grasp, Time pause, const frame::FrameSink& sink) {
        auto frames = std::make_shared<int>(0);
        const auto block = [this, pause, frames](size_t device) {
            if (device != 1 || ++*frames != kTick) return;
            std::this_thread::sleep_for(pause);
            blocked();
        };
        if (grasp.hd != nullptr) {
            grasp.hd->real_time = true;
            grasp.hd->in_frame = block;
        } else {
            grasp.dhd->in_position = block;
        }
        const std::atomic<bool> stop{false};
        Timing timing;
        timing.reserve(1000);
        run_real(*grasp.servo, {}, sink, Time(0), milliseconds(700), stop, timing);
        return timing;
    }
    std::function<void()> blocked = [] {};
};

TEST_P(Late, By5MsIsAnOverrun) {
    frame::Settings settings;
    settings.safety.max_pause = 1;  // pauses of a busy machine are not the subject of this test
    settings.safety.hand_damping = 100;
    Grasp grasp(GetParam(), settings);
    double force = 0;
    const Timing timing = run(grasp, milliseconds(5), [&](const frame::Frame& frame) {
        force = frame.fingers[1].f_sent_W.norm();
    });
    EXPECT_GE(timing.overruns, 1);
    EXPECT_FALSE(grasp.servo->fault()) << grasp.told();
    EXPECT_GT(force, 0.1);
}

TEST_P(Late, By50MsTakesAllForceAway) {
    Grasp grasp(GetParam());
    run(grasp, milliseconds(50), [&](const frame::Frame& frame) {
        if (frame.sequence < kTick) return;  // frames count from 0, blocking ticks from 1
        EXPECT_NE(frame.status & kForceOff, 0u) << frame.sequence;
        EXPECT_EQ(grasp.acting(0), 0);
        EXPECT_EQ(grasp.acting(1), 0);
    });
    if (testing::kSanitized) return;
    // on a busy machine, some other pause may have come first
    EXPECT_EQ(grasp.servo->fault().kind, FaultKind::late);
    EXPECT_NE(grasp.told().find("look for a device that blocks"), std::string::npos)
        << grasp.told();
}
INSTANTIATE_TEST_SUITE_P(Servo, Late, ::testing::Values("openhaptics", "forcedimension"));

TEST(LateCalls, OfDevicesThatPaceAreOverrunsThoughNoTickIs) {
    frame::Settings settings;
    settings.safety.max_pause = 1;
    Grasp grasp("openhaptics", settings);
    grasp.hd->real_time = true;
    grasp.hd->before_tick = [](int tick) {
        if (tick == 200) std::this_thread::sleep_for(milliseconds(5));
        return true;
    };
    const std::atomic<bool> stop{false};
    Timing timing;
    timing.reserve(1000);
    uint32_t status = 0;
    int64_t recorded = 0;
    run_real(
        *grasp.servo, {},
        [&](const frame::Frame& frame) {
            if (frame.sequence == 200) status = frame.status;
            recorded += (frame.status & kOverrun) != 0;
        },
        Time(0), milliseconds(300), stop, timing);
    EXPECT_EQ(timing.overruns, recorded);
    if (!testing::kSanitized) {
        EXPECT_NE(status & kOverrun, 0u);
    }
}

class LateStopped : public Late {};
TEST_P(LateStopped, ACallThatBlocksIsNotWaitedFor) {
    Grasp grasp(GetParam());
    double force = 1;
    // called while the call is still blocked
    blocked = [&] { force = grasp.acting(0) + grasp.acting(1); };
    const Timing timing = run(grasp, milliseconds(200), {});
    if (testing::kSanitized) return;
    EXPECT_EQ(force, 0);
    ASSERT_TRUE(timing.stall.has_value());
    EXPECT_TRUE(timing.stall->stopped);
}
INSTANTIATE_TEST_SUITE_P(Servo, LateStopped, ::testing::Values("forcedimension"));

}  // namespace
}  // namespace dihaptic::servo::makers_faults_test
