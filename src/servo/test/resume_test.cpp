// Tests that force starts at zero after a pause and after a fault, regardless of the force before.
#include <gtest/gtest.h>

#include "planted.h"
#include "testing/allocation_guard.h"

namespace dihaptic::servo::resume_test {
namespace {

/// A reason why force ends, and the event that a test causes to produce it.
struct Cause {
    const char* name;
    haptics::FaultKind kind;
    std::function<void(PlantedGrasp&)> plant;
};

void plant(PlantedGrasp& grasp, const std::function<void(devices::Reading&)>& change) {
    grasp.devices->plant = [change](std::span<devices::Reading> readings) { change(readings[1]); };
}

void PrintTo(const Cause& cause, std::ostream* out) {
    *out << cause.name;
}

class ForceAfter : public ::testing::TestWithParam<Cause> {};

void expect_soft_beginning(PlantedGrasp& grasp) {
    ASSERT_FALSE(grasp.servo->fault());
    const double soft_start = grasp.servo->settings().safety.soft_start;
    double last = 0;
    for (int i = 0; i < 300; ++i) {
        const frame::Frame& frame = grasp.tick();
        ASSERT_EQ(frame.status & kForceOff, 0u) << i;
        if (i == 0) {
            ASSERT_EQ(grasp.told(), 0);
        }
        if (grasp.told() == 0) continue;
        // force ramps up as a fraction of the request, without a step: 1 % of 8.5 N is more than
        // any tick adds
        const double share = std::min(1.0, i * 1e-3 / soft_start);
        const double asked =
            std::max(frame.fingers[0].f_asked_W.norm(), frame.fingers[1].f_asked_W.norm());
        ASSERT_LE(grasp.told(), share * asked + 1e-9) << i;
        ASSERT_LT(grasp.told() - last, 0.085) << i;
        last = grasp.told();
    }
    EXPECT_GT(last, 0.5);
}

TEST_P(ForceAfter, BeginsAtZeroAndComesOnSoftly) {
    PlantedGrasp grasp;
    grasp.grasp();
    ASSERT_GT(grasp.told(), 0.5);
    if (GetParam().plant) {
        GetParam().plant(grasp);
        for (int i = 0; i < 20; ++i) {
            grasp.tick();
            ASSERT_EQ(grasp.told(), 0) << i;
        }
        EXPECT_EQ(grasp.servo->fault().kind, GetParam().kind);
    }
    grasp.devices->plant = {};
    grasp.servo->rest();
    ASSERT_EQ(grasp.told(), 0);
    grasp.servo->resume();
    expect_soft_beginning(grasp);
}
INSTANTIATE_TEST_SUITE_P(
    Servo, ForceAfter,
    ::testing::Values(
        Cause{"pause", haptics::FaultKind::none, {}},
        Cause{"bad_reading", haptics::FaultKind::bad_reading,
              [](PlantedGrasp& g) {
                  plant(g, [](devices::Reading& r) { r.v_DH.x() = kUnmeasured; });
              }},
        Cause{"not_answering", haptics::FaultKind::not_answering,
              [](PlantedGrasp& g) {
                  plant(g, [](devices::Reading& r) { r.status |= kNotAnswering; });
              }},
        Cause{"uncalibrated", haptics::FaultKind::uncalibrated,
              [](PlantedGrasp& g) {
                  plant(g, [](devices::Reading& r) { r.status |= kUncalibrated; });
              }},
        Cause{"device_fault", haptics::FaultKind::device_fault,
              [](PlantedGrasp& g) {
                  plant(g, [](devices::Reading& r) { r.status |= kDeviceFault; });
              }},
        Cause{"too_fast", haptics::FaultKind::too_fast,
              [](PlantedGrasp& g) { plant(g, [](devices::Reading& r) { r.p_DH.z() += 0.1; }); }},
        Cause{"late", haptics::FaultKind::late,
              [](PlantedGrasp& g) { g.now += std::chrono::milliseconds(50); }},
        Cause{"not_finite", haptics::FaultKind::not_finite,
              [](PlantedGrasp& g) {
                  g.tick([](const frame::Frame&, std::span<const frame::Handle>,
                            frame::Commands& commands) {
                      frame::LoadFrame load;
                      load.body = 2;  // proxy of the first finger, so the load is a force field
                      load.force_W.x() = kUnmeasured;
                      commands.task.loads.push_back(load);
                  });
              }}),
    [](const auto& which) { return which.param.name; });

TEST(ForceAfterAPause, BeginsAtZeroWithoutASoftStartToo) {
    frame::Settings settings;
    settings.safety.soft_start = 0;
    PlantedGrasp grasp(settings);
    grasp.grasp();
    grasp.servo->rest();
    grasp.servo->resume();
    const frame::Frame& frame = grasp.tick();
    EXPECT_EQ(grasp.told(), 0);
    EXPECT_NE(frame.status & kResumed, 0u);
    grasp.tick();
    EXPECT_GT(grasp.told(), 0.5);
}

TEST(ForceAfterAPause, OfASlowSlewLimitIsZeroInFreeAir) {
    frame::Settings settings;
    settings.safety.max_force_rate = 100;
    PlantedGrasp grasp(settings);
    grasp.grasp();
    ASSERT_GT(grasp.told(), 0.5);
    grasp.servo->rest();
    grasp.devices->plant = [](std::span<devices::Reading> readings) {
        for (devices::Reading& reading : readings) reading.p_DH.z() += 0.2;
    };
    grasp.servo->resume();
    for (int i = 0; i < 100; ++i) {
        grasp.tick();
        ASSERT_EQ(grasp.told(), 0) << i;
    }
}

TEST(ForceAfterAFault, StaysOffWhileDevicesRefuse) {
    PlantedGrasp grasp;
    grasp.grasp();
    plant(grasp, [](devices::Reading& r) { r.status |= kDeviceFault; });
    grasp.tick();
    grasp.devices->fails = true;
    EXPECT_THROW(grasp.servo->resume(), Error);
    EXPECT_TRUE(grasp.servo->fault());
    EXPECT_EQ(grasp.told(), 0);
}

}  // namespace
}  // namespace dihaptic::servo::resume_test
