// Faults injected at random ticks of a grasp, with devices that fail as real ones do.
#include <gtest/gtest.h>

#include <thread>

#include "base/random.h"
#include "lift.h"
#include "servo/run.h"
#include "testing/allocation_guard.h"

namespace dihaptic::servo {
namespace {

enum class Injected { nan, gone, jump, late };

/// Devices of another group, one of which fails at its n-th reading.
class FailingGroup final : public devices::DeviceGroup {
  public:
    struct Plan {
        Injected what;
        int tick;
        size_t device;
        bool sleeps = false;  ///< late: really, for the real clock
    };
    FailingGroup(std::unique_ptr<devices::DeviceGroup> inner, const Plan& plan)
        : DeviceGroup(real_infos(*inner)), inner_(std::move(inner)), plan_(plan) {}

    std::array<Vec3, 2> told{};  ///< what the devices were last told [N]

  private:
    void do_activate() override { inner_->activate(); }
    void do_deactivate() override { inner_->deactivate(); }
    void do_read(Time now, std::span<devices::Reading> readings) noexcept override {
        inner_->read(now, readings);
        const int tick = tick_++;
        devices::Reading& reading = readings[plan_.device];
        if (plan_.what == Injected::gone && tick >= plan_.tick) {
            reading = {};
            reading.status = devices::kNotAnswering;
        }
        if (tick != plan_.tick) return;
        if (plan_.what == Injected::nan) reading.p_DH.y() = kUnmeasured;
        if (plan_.what == Injected::jump) reading.p_DH.x() += 0.1;
        if (plan_.what == Injected::late && plan_.sleeps)
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    void do_write(std::span<const Wrench> wrenches_D) noexcept override {
        for (size_t i = 0; i < told.size(); ++i) told[i] = wrenches_D[i].force;
        inner_->write(wrenches_D);
    }

    std::unique_ptr<devices::DeviceGroup> inner_;
    Plan plan_;
    int tick_ = 0;
};

/// Two fingers that have closed on a block after 0.3 s, and lift it.
struct Grasp {
    hand::HandSpec hand = lifting_hand();
    std::unique_ptr<hand::ScriptDriver> driver;
    FailingGroup* devices = nullptr;
    std::unique_ptr<Servo> servo;

    explicit Grasp(const FailingGroup::Plan& plan, const Settings& settings = {}) {
        const scene::Scene scene = block_on_table();
        const auto fingers = scene::finger_names(scene);
        driver = std::make_unique<hand::ScriptDriver>(hand, fingers);
        const rig::Rig rig = rig::simulated_rig(fingers);
        devices::Context context;
        context.driver = driver.get();
        context.impedance = hand.impedance;
        auto group = std::make_unique<FailingGroup>(rig::make_devices(rig, fingers, context), plan);
        devices = group.get();
        servo =
            std::make_unique<Servo>(scene, settings, std::move(group), rig::poses(rig, fingers));
        servo->activate();
    }
};

bool finite(const Frame& frame) {
    bool out = true;
    for (const FingerFrame& finger : frame.fingers)
        out = out && finger.p_WH.allFinite() && finger.p_WP.allFinite() &&
              finger.f_sent_W.allFinite();
    for (const BodyFrame& body : frame.bodies) out = out && body.X_WB.p.allFinite();
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
        const int tick = static_cast<int>(random.uniform(350, 750));  // in the grasp
        const FailingGroup::Plan plan{GetParam().what, tick,
                                      random.uniform(0, 1) < 0.5 ? size_t{0} : size_t{1}};
        Grasp grasp(plan);
        const testing::AllocationGuard guard;
        for (int i = 0; i < 900; ++i) {
            // a pause is seen by the next tick's time
            const Time pause = GetParam().what == Injected::late && i > tick
                                   ? std::chrono::milliseconds(50)
                                   : std::chrono::milliseconds(0);
            const Frame& frame = grasp.servo->tick(i * std::chrono::milliseconds(1) + pause, {});
            ASSERT_TRUE(finite(frame)) << i;
            ASSERT_EQ(frame.sequence, i);
            const int fault_tick = tick + (GetParam().what == Injected::late ? 1 : 0);
            if (i < fault_tick) {
                ASSERT_EQ(frame.status, 0u) << i;
                if (i > 340) {
                    ASSERT_GT(grasp.devices->told[0].norm(), 0.5);
                    ASSERT_GT(grasp.devices->told[1].norm(), 0.5);
                }
                continue;
            }
            ASSERT_NE(frame.status & kForceOff, 0u) << i;
            ASSERT_EQ(grasp.devices->told[0], Vec3::Zero()) << i;
            ASSERT_EQ(grasp.devices->told[1], Vec3::Zero()) << i;
            ASSERT_EQ(frame.fingers[0].f_sent_W, Vec3::Zero());
            if (i > fault_tick) continue;
            const haptics::Fault& fault = grasp.servo->fault();
            EXPECT_NE(frame.status & GetParam().status, 0u);
            EXPECT_EQ(fault.kind, GetParam().kind);
            EXPECT_EQ(fault.time, frame.time);
            EXPECT_EQ(fault.device,
                      GetParam().what == Injected::late ? -1 : static_cast<int>(plan.device));
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
    Settings settings;  // an explicit spring far beyond m / h^2 diverges
    settings.coupling.kind = haptics::CouplingKind::dual_spring;
    settings.coupling.stiffness = 1e6;
    settings.coupling.body_mass = 1e-7;
    Grasp grasp({Injected::nan, -1, 0}, settings);  // the devices are well
    int off = 0;
    for (int i = 0; i < 800; ++i) {
        const Frame& frame = grasp.servo->tick(i * std::chrono::milliseconds(1), {});
        if (off == 0 && (frame.status & kNotFinite) == 0) continue;
        ++off;
        ASSERT_NE(frame.status & kForceOff, 0u) << i;
        ASSERT_EQ(grasp.devices->told[0], Vec3::Zero()) << i;
        ASSERT_EQ(grasp.devices->told[1], Vec3::Zero()) << i;
    }
    EXPECT_GT(off, 0);
    EXPECT_EQ(grasp.servo->fault().kind, haptics::FaultKind::diverged);
}

TEST(FaultsInRealTime, ACallThatBlocksLeavesNoForceInTheNextTick) {
    constexpr int kTick = 400;
    Grasp grasp({Injected::late, kTick, 0, true});
    const std::atomic<bool> stop{false};
    Timing timing;
    timing.reserve(1000);
    run_real(
        *grasp.servo, {},
        [&](const Frame& frame) {
            if (frame.sequence <= kTick) return;
            EXPECT_NE(frame.status & kForceOff, 0u) << frame.sequence;
            EXPECT_EQ(grasp.devices->told[0], Vec3::Zero());
            EXPECT_EQ(grasp.devices->told[1], Vec3::Zero());
        },
        Time(0), std::chrono::milliseconds(600), stop, timing);
    // on a busy machine another pause may have come first
    EXPECT_EQ(grasp.servo->fault().kind, haptics::FaultKind::late);
}

}  // namespace
}  // namespace dihaptic::servo
