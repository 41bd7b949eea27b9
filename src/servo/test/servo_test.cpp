#include "servo/servo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <thread>

#include "lift.h"
#include "planted_group.h"
#include "servo/run.h"
#include "testing/allocation_guard.h"

namespace dihaptic::servo::servo_test {
namespace {

/// Two fingers that close on a block on a table and lift it.
struct Grasp {
    scene::Scene scene = block_on_table();
    hand::HandSpec hand = lifting_hand();
    std::unique_ptr<hand::ScriptDriver> driver;
    std::unique_ptr<Servo> servo;

    using Wrap =
        std::function<std::unique_ptr<devices::DeviceGroup>(std::unique_ptr<devices::DeviceGroup>)>;

    explicit Grasp(const frame::Settings& settings = {}, const std::string& options = "",
                   const Wrap& wrap = {}) {
        hand.script.push_back({"hold", 0.3, {}, Vec3::Zero(), false});
        const auto fingers = scene::finger_names(scene);
        driver = std::make_unique<hand::ScriptDriver>(hand, fingers);
        rig::Rig rig = rig::simulated_rig(fingers);
        rig.devices[1].rotation = {0.5, 0.2, 1.1};
        rig.devices[1].position = {0.3, 0, 0};
        if (!options.empty()) {
            for (rig::Device& device : rig.devices)
                device.options = parse_yaml(options, "rig.yaml");
        }
        devices::Context context;
        context.driver = driver.get();
        context.impedance = hand.impedance;
        context.tick = settings.tick();
        auto devices = rig::make_devices(rig, fingers, context);
        servo = std::make_unique<Servo>(scene, settings,
                                        wrap ? wrap(std::move(devices)) : std::move(devices),
                                        rig::poses(rig, fingers));
        servo->activate();
    }
    const frame::Frame& run(double from, double to, const frame::FrameSink& sink = {}) {
        const frame::Frame* frame = nullptr;
        for (double t = from; t < to - 1e-9; t += 1e-3) {
            frame = &servo->tick(from_seconds(t), {});
            if (sink) sink(*frame);
        }
        return *frame;
    }
};

/// The fingers are lower by half the weight divided by the stiffness of 300 and 1000 N/m in series.
constexpr double kLiftedHeight = 0.07 - 0.1 * 9.81 / 2 / (300.0 * 1000 / 1300);

class TwoPoints : public ::testing::TestWithParam<frame::PointFriction> {
  protected:
    frame::Settings settings;
    TwoPoints() {
        settings.proxy.kind = scene::ProxyKind::point;
        settings.proxy.friction = GetParam();
    }
    bool apart() const { return GetParam() == frame::PointFriction::apart; }
};
INSTANTIATE_TEST_SUITE_P(Servo, TwoPoints,
                         ::testing::Values(frame::PointFriction::together,
                                           frame::PointFriction::apart),
                         [](const auto& of) { return std::string(enum_name(of.param)); });

TEST_P(TwoPoints, LiftABlockAndMeasureTheGrasp) {
    Grasp grasp(settings);
    double momentum = 0;
    Vec3 impulse = Vec3::Zero();
    const frame::Frame& frame = grasp.run(0, 1.1, [&](const frame::Frame& f) {
        // the block receives the same force as the hands (one step later for apart points), equal
        // from both sides
        momentum = f.bodies[1].v_WB.x() * 0.1;
        if (apart()) {
            EXPECT_NEAR(impulse.x(), momentum, 1e-6);
        }
        for (const frame::FingerFrame& finger : f.fingers) {
            impulse -= finger.f_contact_W * 1e-3;
            EXPECT_EQ(finger.f_asked_W, finger.f_contact_W);
        }
        if (!apart()) {
            EXPECT_NEAR(impulse.x(), momentum, 1e-6);
        }
    });
    EXPECT_EQ(frame.status, 0u);
    EXPECT_NEAR(frame.bodies[1].X_WB.p.z(), kLiftedHeight, 1e-4);
    // points lack the pads' thickness, so the targets are 5 mm beyond contact
    EXPECT_NEAR(frame.grip_force / (0.005 * 300 * 1000 / 1300), 1, 0.01);
    EXPECT_NEAR(frame.load_force / (0.1 * 9.81), 1, 0.01);
    ASSERT_EQ(frame.contacts.size(), 2u);
    EXPECT_EQ(frame.contacts[0].a, 1);
    EXPECT_EQ(frame.contacts[0].b, 2);
    EXPECT_EQ(frame.contacts[0].points, 1);
    EXPECT_NEAR(frame.contacts[0].p_WC.x(), -0.02, 2e-5);
}

TEST_P(TwoPoints, AllocateNothingInATick) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Grasp grasp(settings);
    const testing::AllocationGuard guard;
    for (int i = 0; i < 1000; ++i) grasp.servo->tick(from_seconds(i * 1e-3), {});
    EXPECT_EQ(guard.count(), 0u);
}

TEST(Servo, LiftsABlockAndMeasuresTheGrasp) {
    Grasp grasp;
    const frame::Frame& frame = grasp.run(0, 1.1);
    EXPECT_EQ(frame.status, 0u);
    EXPECT_NEAR(frame.bodies[1].X_WB.p.z(), kLiftedHeight, 1e-4);
    // the targets are 7.5 mm beyond contact, through 300 and 1000 N/m in series
    EXPECT_NEAR(frame.grip_force / (0.0075 * 300 * 1000 / 1300), 1, 0.01);
    EXPECT_NEAR(frame.load_force / (0.1 * 9.81), 1, 0.01);
    EXPECT_NEAR(-frame.fingers[0].f_sent_W.z() - frame.fingers[1].f_sent_W.z(), 0.1 * 9.81, 0.01);
    EXPECT_NEAR(frame.fingers[0].f_sent_W.x(), -frame.grip_force, 1e-2);
    EXPECT_EQ(frame.contacts.size(), 2u);  // one contact per finger: the block has left the table
    EXPECT_EQ(frame.contacts[0].points, 4);
}

TEST(Servo, TheForceWrittenBelongsToThePositionRead) {
    // pressing a wall at speed: the force of each tick must match the depth in that same tick
    Grasp grasp;
    grasp.run(0, 0.25, [](const frame::Frame& frame) {
        const frame::FingerFrame& thumb = frame.fingers[0];
        if (thumb.normal_force <= 0) return;
        const double stretch = thumb.p_WP.x() - thumb.p_WH.x();
        const double spring = 1000 * stretch + 0.5 * (thumb.v_WP.x() - thumb.v_WH.x());
        EXPECT_NEAR(thumb.f_sent_W.x(), spring, 1e-9);
    });
}

TEST(Servo, IsTheSameWhereverTheDevicesStand) {
    Grasp here;
    Grasp there;  // the second device is turned, so the fingers are compared with each other
    const frame::Frame& frame = here.run(0, 1.1);
    EXPECT_NEAR(frame.fingers[0].f_sent_W.x(), -frame.fingers[1].f_sent_W.x(), 1e-6);
    EXPECT_NEAR(frame.fingers[0].f_sent_W.z(), frame.fingers[1].f_sent_W.z(), 1e-6);
}

TEST(Servo, AllocatesNothingAfterActivation) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    for (const auto kind : {frame::CouplingKind::implicit, frame::CouplingKind::dual_spring,
                            frame::CouplingKind::velocity_impulse}) {
        for (const char* options : {"", "preset: premium_1_0\ndelay_ticks: 1\n"}) {
            frame::Settings settings;
            settings.coupling.kind = kind;
            settings.coupling.stiffness = 500;
            settings.coupling.onset = 0.05;
            Grasp grasp(settings, options);
            const frame::Director director = [](const frame::Frame&, std::span<const frame::Handle>,
                                                frame::Commands& commands) {
                commands.phase = 1;
                add(commands.task.loads, {1, {0, 0, 0.01}, Vec3::Zero()});
            };
            const testing::AllocationGuard guard;
            for (int i = 0; i < 1100; ++i)
                grasp.servo->tick(i * std::chrono::milliseconds(1), director);
            EXPECT_EQ(guard.count(), 0u);
        }
    }
}

TEST(Servo, TheAllocationGuardSeesADirectorThatAllocates) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Grasp grasp;
    std::vector<int> grows;
    const frame::Director director = [&](const frame::Frame&, std::span<const frame::Handle>,
                                         frame::Commands&) { grows.push_back(1); };
    const testing::AllocationGuard guard;
    grasp.servo->tick(Time(0), director);
    EXPECT_GT(guard.count(), 0u);
}

TEST(Servo, RepeatsItselfToTheBit) {
    Grasp a, b;
    const frame::Frame& last_a = a.run(0, 1.1);
    const frame::Frame& last_b = b.run(0, 1.1);
    EXPECT_EQ(last_a.fingers[0].f_sent_W, last_b.fingers[0].f_sent_W);
    EXPECT_EQ(last_a.bodies[1].X_WB.p, last_b.bodies[1].X_WB.p);
}

TEST(Servo, KeepsTheForceWithinItsLimitsAndSaysSo) {
    frame::Settings settings;
    settings.safety.max_force = 1.0;
    settings.safety.max_force_rate = 20;
    Grasp grasp(settings);
    Vec3 last = Vec3::Zero();
    uint32_t status = 0;
    grasp.run(0, 0.6, [&](const frame::Frame& frame) {
        const Vec3& f = frame.fingers[0].f_sent_W;
        EXPECT_LE(f.norm(), 1.0 + 1e-12);
        EXPECT_LE((f - last).norm(), 20 * 1e-3 + 1e-12);
        last = f;
        status |= frame.status;
    });
    EXPECT_TRUE(status & kForceLimited);
    EXPECT_TRUE(status & kRateLimited);
}

TEST(Servo, TellsOfHandlesOutsideTheirWorkspace) {
    Grasp grasp({}, "workspace_mm: [10, 10, 10]\n");
    EXPECT_TRUE(grasp.run(0, 0.1).status & kOutsideWorkspace);
}

TEST(Servo, TellsThatABodyDiverged) {
    Grasp grasp;
    grasp.run(0, 0.05);
    const frame::Director push = [&](const frame::Frame&, std::span<const frame::Handle>,
                                     frame::Commands& commands) {
        add(commands.task.loads, {1, {1e300, 0, 0}, Vec3::Zero()});
    };
    uint32_t status = 0;
    for (int i = 0; i < 1000 && (status & kNotFinite) == 0; ++i)
        status |= grasp.servo->tick(from_seconds(0.05 + 1e-3 * i), push).status;
    EXPECT_NE(status & kNotFinite, 0u);
}

TEST(Servo, OrdersLastOrAreForOneTickAsTheirTypesSay) {
    frame::Settings settings;
    settings.coupling.stiffness = 700;
    settings.dynamics.solver = contact::Solver::staggered_projections;
    Grasp grasp(settings);
    const frame::Frame& frame = grasp.servo->tick(Time(0), {});
    EXPECT_EQ(frame.stiffness, 700);
    EXPECT_TRUE(std::isnan(frame.damping));
    EXPECT_EQ(frame.solver, contact::Solver::staggered_projections);
    const frame::Knobs before = frame;
    grasp.servo->tick(std::chrono::milliseconds(1),
                      [](const frame::Frame&, std::span<const frame::Handle>, frame::Commands& c) {
                          c.trial = 3;
                          c.knobs.stiffness = 900;
                          c.knobs.damping = 2;
                          c.knobs.friction_scale = 0.5;
                          c.knobs.solver = contact::Solver::newton;
                          c.stop = true;
                          c.task.marker = 7;
                      });
    EXPECT_TRUE(grasp.servo->stopped());
    EXPECT_EQ(frame.task.marker, 7);
    grasp.servo->tick(std::chrono::milliseconds(2), {});
    EXPECT_FALSE(grasp.servo->stopped());
    EXPECT_EQ(frame.task.marker, 0);
    EXPECT_EQ(frame.trial, 3);
    EXPECT_EQ(frame.stiffness, 900);
    EXPECT_EQ(frame.damping, 2);
    EXPECT_EQ(frame.smoothing, before.smoothing);
    EXPECT_EQ(frame.friction_scale, 0.5);
    EXPECT_EQ(frame.solver, contact::Solver::newton);
}

TEST(Servo, DynamicsMayBeSlower) {
    frame::Settings settings;
    settings.dynamics.every = 10;
    Grasp grasp(settings);
    const frame::Frame& frame = grasp.run(0, 1.1);
    EXPECT_NEAR(frame.bodies[1].X_WB.p.z(), kLiftedHeight, 1e-4);
    EXPECT_NEAR(frame.load_force / (0.1 * 9.81), 1, 0.01);
}

TEST(Servo, LoadsOfTheDirectorActOnBodies) {
    Grasp grasp;
    const frame::Director push = [](const frame::Frame&, std::span<const frame::Handle>,
                                    frame::Commands& commands) {
        add(commands.task.loads, {1, {0, 0, 2 * 0.1 * 9.81}, Vec3::Zero()});
    };
    for (int i = 0; i < 100; ++i) grasp.servo->tick(i * std::chrono::milliseconds(1), push);
    const frame::Frame& frame = grasp.servo->tick(std::chrono::milliseconds(100), push);
    EXPECT_NEAR(frame.bodies[1].v_WB.z(), 9.81 * 0.101, 1e-6);
}

/// Settings that allow proxies to change between rigid bodies and points.
class Changeable : public ::testing::TestWithParam<frame::PointFriction> {
  protected:
    frame::Settings settings;
    Changeable() {
        settings.proxy.friction = GetParam();
        settings.proxy.changeable = true;
    }
};
INSTANTIATE_TEST_SUITE_P(Servo, Changeable,
                         ::testing::Values(frame::PointFriction::together,
                                           frame::PointFriction::apart),
                         [](const auto& of) { return std::string(enum_name(of.param)); });

TEST_P(Changeable, ProxiesAreAsIfTheyHadAlwaysBeenOfTheirKind) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    // `kind` is the kind of proxy; `changed` is whether it results from a change
    const auto lift = [&](scene::ProxyKind kind, bool changed) {
        frame::Settings own = settings;
        const auto other =
            kind == scene::ProxyKind::rigid ? scene::ProxyKind::point : scene::ProxyKind::rigid;
        own.proxy.kind = changed ? other : kind;
        Grasp grasp(own);
        const frame::Director order = [&](const frame::Frame&, std::span<const frame::Handle>,
                                          frame::Commands& commands) {
            if (changed) commands.knobs.proxy = kind;
        };
        const testing::AllocationGuard guard;
        for (int i = 0; i < 1100; ++i) grasp.servo->tick(i * std::chrono::milliseconds(1), order);
        EXPECT_EQ(guard.count(), 0u);
        return grasp.servo->tick(std::chrono::milliseconds(1100), order);
    };
    for (const auto kind : {scene::ProxyKind::rigid, scene::ProxyKind::point}) {
        const frame::Frame always = lift(kind, false);
        const frame::Frame since = lift(kind, true);
        EXPECT_EQ(always.proxy, kind);
        EXPECT_EQ(since.proxy, kind);
        EXPECT_GT(always.bodies[1].X_WB.p.z(), 0.06);
        EXPECT_NEAR(since.bodies[1].X_WB.p.z(), always.bodies[1].X_WB.p.z(), 1e-4);
        EXPECT_NEAR(since.grip_force, always.grip_force, 0.01);
    }
}

TEST_P(Changeable, ProxiesPassThroughNothingAndHoldNothingBackAsTheyChangeToAndFro) {
    Grasp grasp(settings);
    double most = 0;
    for (int i = 0; i < 100; ++i) {  // the fingers are in the air, before closing
        const frame::Director order = [&](const frame::Frame&, std::span<const frame::Handle>,
                                          frame::Commands& commands) {
            commands.knobs.proxy =
                i / 10 % 2 == 0 ? scene::ProxyKind::rigid : scene::ProxyKind::point;
        };
        const frame::Frame& frame = grasp.servo->tick(i * std::chrono::milliseconds(1), order);
        for (const frame::FingerFrame& finger : frame.fingers) {
            most = std::max(most, finger.f_sent_W.norm());
            EXPECT_LT((finger.p_WP - finger.p_WH).norm(), 1e-3);
        }
        EXPECT_TRUE(frame.contacts.size() <= 8);  // no more than the block's own contacts
    }
    EXPECT_LT(most, 0.1);
}

TEST(Run, VirtualTimeStopsWhenToldAndCountsTicks) {
    Grasp grasp;
    const std::atomic<bool> stop{false};
    TickTimes times;
    times.reserve(2000);
    int frames = 0;
    const frame::Director director = [](const frame::Frame& last, std::span<const frame::Handle>,
                                        frame::Commands& commands) {
        commands.stop = last.sequence == 98;
    };
    run_virtual(
        *grasp.servo, director, [&](const frame::Frame&) { ++frames; }, std::chrono::seconds(10),
        stop, &times);
    EXPECT_EQ(frames, 100);
    EXPECT_EQ(times.count(), 100u);
    EXPECT_GT(times.quantile(1), 0);
}

TEST(Servo, HoldsTheSameGraspAtEveryRate) {
    // whatever the rate, the hand feels only statics: the block's weight, and two springs in series
    for (const double rate : {1000.0, 2000.0, 4000.0}) {
        frame::Settings settings;
        settings.rate = rate;
        Grasp grasp(settings);
        const std::atomic<bool> stop{false};
        frame::Frame frame;
        run_virtual(
            *grasp.servo, {}, [&](const frame::Frame& last) { frame = last; },
            from_seconds(grasp.driver->duration()), stop);
        EXPECT_EQ(frame.time, from_seconds(1.1)) << rate;
        EXPECT_EQ(frame.sequence, std::lround(1.1 * rate)) << rate;
        EXPECT_EQ(frame.status, 0u) << rate;
        EXPECT_NEAR(frame.bodies[1].X_WB.p.z(), kLiftedHeight, 1e-4) << rate;
        EXPECT_NEAR(frame.grip_force / (0.0075 * 300 * 1000 / 1300), 1, 0.01) << rate;
        EXPECT_NEAR((-frame.fingers[0].f_sent_W.z() - frame.fingers[1].f_sent_W.z()) / (0.1 * 9.81),
                    1, 0.01)
            << rate;
    }
}

TEST(Servo, FreeFallIsTheSameAtEveryRate) {
    // with semi-implicit steps of h, a body falls exactly g t (t + h) / 2
    for (const double rate : {1000.0, 2000.0, 4000.0}) {
        frame::Settings settings;
        settings.rate = rate;
        Grasp grasp(settings);
        dynamics::World& world = grasp.servo->world();
        Pose high;
        high.p = {0, 0.3, 0.5};
        world.set_pose({1}, high);
        const auto ticks = static_cast<int>(0.2 * rate);
        for (int i = 0; i < ticks; ++i) grasp.servo->tick(i * grasp.servo->period(), {});
        const double fallen = 9.81 / 2 * 0.2 * (0.2 + 1 / rate);
        EXPECT_NEAR(world.state({1}).X_WB.p.z(), 0.5 - fallen, 1e-9) << rate;
    }
}

TEST(Run, RealTimeKeepsPhaseAfterAnOverrun) {
    Grasp grasp;
    const std::atomic<bool> stop{false};
    Timing timing;
    timing.reserve(1000);
    struct Seen {
        frame::Frame frame;
        std::chrono::steady_clock::time_point ended;
    };
    std::vector<Seen> seen;
    seen.reserve(1000);
    const Time first = std::chrono::milliseconds(7);
    run_real(
        *grasp.servo, {},
        [&](const frame::Frame& frame) {
            if (frame.sequence == 50)
                std::this_thread::sleep_for(std::chrono::microseconds(20300));  // an overrun
            seen.push_back({frame, std::chrono::steady_clock::now()});
        },
        first, first + std::chrono::milliseconds(200), stop, timing);
    ASSERT_GT(seen.size(), 60u);
    EXPECT_EQ(seen.front().frame.time, first);
    EXPECT_EQ(timing.reached, seen.back().frame.time);
    EXPECT_GE(timing.overruns, 1);
    EXPECT_GE(seen[51].frame.time - seen[50].frame.time, std::chrono::milliseconds(21));
    EXPECT_TRUE(seen[51].frame.status & kOverrun);
    int64_t recorded = 0;
    // time was zero at this moment, or earlier by at most the duration of the fastest tick
    auto zero = seen.front().ended - seen.front().frame.time;
    for (const Seen& s : seen) zero = std::min(zero, s.ended - s.frame.time);
    for (size_t i = 0; i < seen.size(); ++i) {
        const frame::Frame& frame = seen[i].frame;
        EXPECT_EQ((frame.time - first) % grasp.servo->period(), Time(0));
        EXPECT_GE(frame.lateness, 0);
        recorded += (frame.status & kOverrun) != 0;
        if (i == 0) continue;
        EXPECT_GE(zero + frame.time, seen[i - 1].ended);  // no burst: each tick waits for its time
        EXPECT_EQ((frame.status & kOverrun) != 0,
                  frame.time - seen[i - 1].frame.time > grasp.servo->period());
    }
    // no frame follows in which an overrun of the last tick could be recorded
    EXPECT_LE(timing.overruns - recorded, 1);
    EXPECT_EQ(timing.ticks.count(), seen.size());
    EXPECT_EQ(timing.lateness.count(), seen.size());
    EXPECT_NE(describe(timing).find("at worst"), std::string::npos);
}

TEST(Run, RealTimeAllocatesNothing) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Grasp grasp;
    const std::atomic<bool> stop{false};
    Timing timing;
    timing.reserve(1000);
    std::optional<testing::AllocationGuard> guard;  // counts only in the thread that creates it
    size_t count = 1;
    run_real(
        *grasp.servo, {},
        [&](const frame::Frame& frame) {
            if (frame.sequence == 0) guard.emplace();
            if (frame.sequence == 20)
                std::this_thread::sleep_for(std::chrono::milliseconds(3));  // includes overruns
            if (frame.sequence == 100) {
                count = guard->count();
                guard.reset();
            }
        },
        Time(0), std::chrono::milliseconds(300), stop, timing);
    EXPECT_EQ(count, 0u);
    EXPECT_GE(timing.overruns, 1);
}

/// Simulated devices that call the tick themselves, every 2 ms, from their own thread.
class PacingGroup final : public PlantedGroup {
  public:
    using PlantedGroup::PlantedGroup;
    bool paces() const override { return true; }

  private:
    void do_pace(const std::function<bool()>& tick) override {
        std::thread([&] {
            while (tick()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }).join();
    }
};

TEST(Run, IsPacedByDevicesThatDoAndTimeIsThatOfTheirTicks) {
    Grasp grasp({}, "", [](std::unique_ptr<devices::DeviceGroup> inner) {
        return std::make_unique<PacingGroup>(std::move(inner), true);
    });
    const std::atomic<bool> stop{false};
    Timing timing;
    timing.reserve(1000);
    std::vector<Time> times;
    times.reserve(1000);
    const Time first = std::chrono::milliseconds(7);
    run_real(
        *grasp.servo, {}, [&](const frame::Frame& frame) { times.push_back(frame.time); }, first,
        first + std::chrono::milliseconds(100), stop, timing);
    ASSERT_GT(times.size(), 2u);
    EXPECT_EQ(times.front(), first);
    EXPECT_EQ(timing.reached, times.back());
    EXPECT_LE(times.back(), first + std::chrono::milliseconds(100));
    EXPECT_EQ(timing.ticks.count(), times.size());
    for (size_t i = 1; i < times.size(); ++i)
        EXPECT_GE(times[i] - times[i - 1], std::chrono::milliseconds(2));
}

}  // namespace
}  // namespace dihaptic::servo::servo_test
