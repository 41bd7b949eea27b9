// Injects faults at random ticks of a grasp, with devices that fail as real ones do.
#include <gtest/gtest.h>

#include <thread>

#include "base/random.h"
#include "planted.h"
#include "servo/run.h"
#include "testing/allocation_guard.h"
#include "testing/sanitizer.h"

namespace dihaptic::servo::faults_test {
namespace {

enum class Injected { nan, gone, jump, late };

/// Makes one device of a grasp fail in its reading number `tick`.
struct Failure {
    Injected what;
    int tick;
    size_t device;
    bool sleeps = false;  ///< for Injected::late: actually sleeps, for runs on the real clock
};

void inject(PlantedGrasp& grasp, const Failure& failure) {
    grasp.devices->plant = [failure, tick = 0](std::span<devices::Reading> readings) mutable {
        const int now = tick++;
        devices::Reading& reading = readings[failure.device];
        if (failure.what == Injected::gone && now >= failure.tick) {
            reading = {};
            reading.status = kNotAnswering;
        }
        if (now != failure.tick) return;
        if (failure.what == Injected::nan) reading.p_DH.y() = kUnmeasured;
        if (failure.what == Injected::jump) reading.p_DH.x() += 0.1;
        if (failure.what == Injected::late && failure.sleeps)
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
    };
}

bool finite(const frame::Frame& frame) {
    bool out = true;
    for (const frame::FingerFrame& finger : frame.fingers)
        out = out && finger.p_WH.allFinite() && finger.p_WP.allFinite() &&
              finger.f_sent_W.allFinite();
    for (const frame::BodyFrame& body : frame.bodies) out = out && body.X_WB.p.allFinite();
    return out;
}

struct Case {
    Injected what;
    haptics::FaultKind kind;
    Status status;
};
class FaultInjected : public ::testing::TestWithParam<Case> {};

TEST_P(FaultInjected, TakesAllForceAwayInTheSameTickForGood) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Random random(4, "faults");
    for (int trial = 0; trial < 20; ++trial) {
        const int tick = static_cast<int>(random.uniform(350, 750));  // during the grasp
        const Failure failure{GetParam().what, tick,
                              random.uniform(0, 1) < 0.5 ? size_t{0} : size_t{1}};
        PlantedGrasp grasp;
        inject(grasp, failure);
        const testing::AllocationGuard guard;
        for (int i = 0; i < 900; ++i) {
            // a pause shows up in the time of the next tick
            const Time pause = GetParam().what == Injected::late && i > tick
                                   ? std::chrono::milliseconds(50)
                                   : std::chrono::milliseconds(0);
            const frame::Frame& frame =
                grasp.servo->tick(i * std::chrono::milliseconds(1) + pause, {});
            ASSERT_TRUE(finite(frame)) << i;
            ASSERT_EQ(frame.sequence, i);
            const int fault_tick = tick + (GetParam().what == Injected::late ? 1 : 0);
            if (i < fault_tick) {
                ASSERT_EQ(frame.status, 0u) << i;
                if (i > 340) {
                    ASSERT_GT(grasp.devices->told[0].force.norm(), 0.5);
                    ASSERT_GT(grasp.devices->told[1].force.norm(), 0.5);
                }
                continue;
            }
            ASSERT_NE(frame.status & kForceOff, 0u) << i;
            ASSERT_EQ(grasp.told(), 0) << i;
            ASSERT_EQ(frame.fingers[0].f_sent_W, Vec3::Zero());
            if (i > fault_tick) continue;
            const haptics::Fault& fault = grasp.servo->fault();
            EXPECT_NE(frame.status & GetParam().status, 0u);
            EXPECT_EQ(fault.kind, GetParam().kind);
            EXPECT_EQ(fault.time, frame.time);
            EXPECT_EQ(fault.device,
                      GetParam().what == Injected::late ? -1 : static_cast<int>(failure.device));
        }
        EXPECT_EQ(guard.count(), 0u);
    }
}
INSTANTIATE_TEST_SUITE_P(
    Servo, FaultInjected,
    ::testing::Values(Case{Injected::nan, haptics::FaultKind::bad_reading, kBadReading},
                      Case{Injected::gone, haptics::FaultKind::not_answering, kNotAnswering},
                      Case{Injected::jump, haptics::FaultKind::too_fast, kTooFast},
                      Case{Injected::late, haptics::FaultKind::late, kLate}));

TEST(Faults, AWorldThatDivergesIsOneAndEndsForce) {
    frame::Settings settings;  // an explicit spring much stiffer than m / h^2 diverges
    settings.coupling.kind = frame::CouplingKind::dual_spring;
    settings.coupling.stiffness = 1e6;
    settings.coupling.body_mass = 1e-7;
    PlantedGrasp grasp(settings);
    int off = 0;
    for (int i = 0; i < 800; ++i) {
        const frame::Frame& frame = grasp.servo->tick(i * std::chrono::milliseconds(1), {});
        if (off == 0 && (frame.status & kNotFinite) == 0) continue;
        ++off;
        ASSERT_NE(frame.status & kForceOff, 0u) << i;
        ASSERT_EQ(grasp.told(), 0) << i;
    }
    EXPECT_GT(off, 0);
    EXPECT_EQ(grasp.servo->fault().kind, haptics::FaultKind::diverged);
}

TEST(FaultsInRealTime, ACallThatBlocksLeavesNoForceInTheNextTick) {
    constexpr int kTick = 400;
    PlantedGrasp grasp;
    inject(grasp, {Injected::late, kTick, 0, true});
    const std::atomic<bool> stop{false};
    Timing timing;
    timing.reserve(1000);
    run_real(
        *grasp.servo, {},
        [&](const frame::Frame& frame) {
            if (frame.sequence <= kTick) return;
            EXPECT_NE(frame.status & kForceOff, 0u) << frame.sequence;
            EXPECT_EQ(grasp.told(), 0);
        },
        Time(0), std::chrono::milliseconds(600), stop, timing);
    if (testing::kSanitized) return;
    // on a busy machine, some other pause may have come first
    EXPECT_EQ(grasp.servo->fault().kind, haptics::FaultKind::late);
}

}  // namespace
}  // namespace dihaptic::servo::faults_test
