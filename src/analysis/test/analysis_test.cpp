#include <gtest/gtest.h>

#include <numbers>

#include "analysis/events.h"
#include "analysis/fault_record.h"
#include "analysis/grasp_trace.h"
#include "base/number.h"

namespace dihaptic::analysis::analysis_test {
namespace {

/// Returns frame i of a recording of one second in which two fingers, 4 cm apart along x, hold body
/// 1.
frame::Frame held(int i) {
    frame::Frame frame;
    frame.sequence = i;
    frame.time = i * std::chrono::milliseconds(1);
    frame.bodies.resize(2);
    frame.fingers.resize(2);
    frame.fingers[0].p_WP = {-0.02, 0, 0};
    frame.fingers[1].p_WP = {0.02, 0, 0};
    frame.contacts.resize(2);
    for (int f = 0; f < 2; ++f) {
        frame.contacts[static_cast<size_t>(f)].a = 1;
        frame.contacts[static_cast<size_t>(f)].b = 2 + f;
        frame.contacts[static_cast<size_t>(f)].normal_force = 1;
    }
    frame.grip_force = 2;
    frame.load_force = 0.5;
    return frame;
}

GraspTrace trace_of(const std::function<frame::Frame(int)>& make, int count = 1000) {
    GraspTrace trace(1, 1e-3);
    for (int i = 0; i < count; ++i) trace.add(make(i));
    return trace;
}

TEST(FaultRecord, KeepsTheSecondBeforeTheFaultAndItsTick) {
    FaultRecord record({"thumb", "index"});
    for (int i = 0; i < 3000; ++i) {
        frame::Frame frame = held(i);
        frame.fingers[1].f_sent_W = {0, 0, i < 2000 ? 1.5 : 0};
        if (i >= 2000) frame.status = kForceOff;
        if (i == 2000) frame.status |= kTooFast;
        record.add(frame);
    }
    const Table table = record.table();
    ASSERT_EQ(table.rows.size(), 1001u);
    const auto& last = table.rows.back();
    ASSERT_EQ(last.size(), table.columns.size());
    EXPECT_EQ(std::get<double>(table.rows.front()[0]), 1);
    EXPECT_EQ(std::get<double>(last[0]), 2);
    EXPECT_EQ(
        std::get<std::string>(last[1]),
        "force was off, after a fault; a handle jumped, or turned or moved faster than allowed");
    EXPECT_EQ(table.columns.back().name, "index_force_sent_z_N");
    EXPECT_EQ(std::get<double>(last.back()), 0);
    EXPECT_EQ(std::get<double>(table.rows[999].back()), 1.5);
}

TEST(FaultRecord, KeepsWhatLedToEachFaultOfASessionThatWentOn) {
    FaultRecord record({"thumb", "index"});
    for (int i = 0; i < 6000; ++i) {
        frame::Frame frame = held(i);
        // force is off from the first fault until it is remedied, and again after the second fault
        const bool off = (i >= 2000 && i < 3000) || i >= 3500;
        if (off) frame.status = kForceOff;
        if (i == 3000) frame.status = kResumed;
        record.add(frame);
    }
    const Table table = record.table();
    ASSERT_EQ(table.rows.size(), 1001u + 501u);
    EXPECT_EQ(std::get<double>(table.rows[1000][0]), 2);
    EXPECT_EQ(std::get<double>(table.rows[1001][0]), 3);
    EXPECT_EQ(std::get<double>(table.rows.back()[0]), 3.5);
}

TEST(FaultRecord, HasTorqueOfFingersThatTurn) {
    FaultRecord record({"thumb", "index"}, {"index"});
    for (int i = 0; i < 3; ++i) {
        frame::Frame frame = held(i);
        frame.turns.resize(1);
        frame.turns[0].t_sent_W = {0, 0, i < 2 ? 0.1 : 0};
        if (i == 2) frame.status = kForceOff;
        record.add(frame);
    }
    const Table table = record.table();
    ASSERT_EQ(table.rows.size(), 3u);
    ASSERT_EQ(table.rows[1].size(), table.columns.size());
    EXPECT_EQ(table.columns.back().name, "index_torque_sent_z_Nm");
    EXPECT_EQ(std::get<double>(table.rows[1].back()), 0.1);
    EXPECT_EQ(std::get<double>(table.rows[2].back()), 0);
}

TEST(FaultRecord, HasNothingWithoutAFault) {
    FaultRecord calm({"thumb", "index"});
    FaultRecord stopped({"thumb", "index"});
    for (int i = 0; i < 2000; ++i) {
        frame::Frame frame = held(i);
        calm.add(frame);
        if (i == 1999) frame.status = kForceOff | kStopped;
        stopped.add(frame);
    }
    EXPECT_TRUE(calm.table().rows.empty());
    EXPECT_TRUE(stopped.table().rows.empty());
}

TEST(GraspTrace, AStillHoldHasNoFigureButItsForces) {
    const GraspTrace trace = trace_of(held);
    const Range all{0, 1000};
    EXPECT_TRUE(trace.all_touching(all));
    EXPECT_EQ(trace.slip(all), 0);
    EXPECT_EQ(trace.height_range(all), 0);
    EXPECT_EQ(trace.axis_tilt_rms(all), 0);
    EXPECT_EQ(trace.turn(all), 0);
    EXPECT_EQ(trace.mean_grip(all), 2);
    EXPECT_EQ(trace.mean_load(all), 0.5);
    EXPECT_EQ(trace.lift_off(), 0u);
}

TEST(GraspTrace, SlipIsWhatAFingerMovesInTheObjectsFrameNotInTheWorlds) {
    const GraspTrace carried = trace_of([](int i) {
        frame::Frame f = held(i);
        const Pose X{rotation_xyz({0, 0, 1e-3 * i}), {1e-4 * i, 0, 0}};
        f.bodies[1].X_WB = X;
        for (auto& finger : f.fingers) finger.p_WP = X * finger.p_WP;
        return f;
    });
    EXPECT_LT(carried.slip({0, 1000}), 1e-15);
    const GraspTrace slipping = trace_of([](int i) {
        frame::Frame f = held(i);
        f.fingers[1].p_WP.z() -= 1e-6 * i;
        return f;
    });
    EXPECT_NEAR(slipping.slip({0, 1000}), 999e-6, 1e-15);
    EXPECT_NEAR(slipping.slip({500, 600}), 99e-6, 1e-15);
}

TEST(GraspTrace, TurnIsAboutTheLineBetweenTheFingers) {
    const GraspTrace trace = trace_of([](int i) {
        frame::Frame f = held(i);
        f.bodies[1].X_WB.R = rotation_xyz({1e-3 * i, 0, 0});
        return f;
    });
    EXPECT_NEAR(trace.turn({0, 1000}), 0.999, 1e-12);
    EXPECT_NEAR(trace.turn_at(100, 300), 0.2, 1e-12);
}

TEST(GraspTrace, TiltAndHeightOfASine) {
    const double amplitude = 1e-4;
    const GraspTrace trace = trace_of([&](int i) {
        frame::Frame f = held(i);
        const double z = amplitude * std::sin(2 * std::numbers::pi * 10 * i * 1e-3);
        f.bodies[1].X_WB.p.z() = z;
        f.fingers[1].p_WP.z() = z;
        return f;
    });
    EXPECT_NEAR(trace.height_rms({0, 1000}), amplitude / std::numbers::sqrt2, 1e-12);
    EXPECT_NEAR(trace.height_range({0, 1000}), 2 * amplitude, 1e-7);
    EXPECT_NEAR(trace.axis_tilt_rms({0, 1000}), amplitude / 0.04 / std::numbers::sqrt2, 1e-8);
}

TEST(GraspTrace, ForceAbove5HzLeavesOutWhatIsSlower) {
    const auto shaking = [](double frequency) {
        return trace_of(
                   [=](int i) {
                       frame::Frame f = held(i);
                       f.fingers[0].f_sent_W.y() =
                           3 + std::sin(2 * std::numbers::pi * frequency * i * 1e-3);
                       return f;
                   },
                   3000)
            .force_above_5_hz({0, 3000});
    };
    EXPECT_NEAR(shaking(50), 1 / std::numbers::sqrt2, 0.01);
    EXPECT_LT(shaking(0.5), 0.001);
}

TEST(GraspTrace, WeightFeltIsDownOnAllHandles) {
    const GraspTrace trace = trace_of([](int i) {
        frame::Frame f = held(i);
        f.fingers[0].f_sent_W = {1, 0, -0.4};
        f.fingers[1].f_sent_W = {-1, 0, -0.6};
        return f;
    });
    EXPECT_NEAR(trace.weight_felt({0, 1000}), 1.0, 1e-12);
    EXPECT_NEAR(trace.peak_force({0, 1000}), std::hypot(1, 0.6), 1e-12);
}

TEST(GraspTrace, LiftOffIsWhenOnlyFingersCarryTheObject) {
    const GraspTrace trace = trace_of([](int i) {
        frame::Frame f = held(i);
        if (i < 400) {
            frame::ContactFrame& table = f.contacts.emplace_back();
            table.a = 0;
            table.b = 1;
            table.normal_force = 0.3;
        }
        return f;
    });
    EXPECT_EQ(trace.lift_off(), 400u);
}

/// Returns each event as text: time [ms], name and detail.
std::vector<std::string> said_by(const EventFinder& finder) {
    std::vector<std::string> said;
    for (const rows::EventRow& e : finder.events())
        said.push_back(number_text(std::lround(e.time * 1e3)) + " " + e.name + " " + e.detail);
    return said;
}

TEST(Events, FindsTouchesLiftOffPhasesAndLimits) {
    recording::LogHead head;
    head.fingers = {"thumb", "index"};
    head.bodies = {"table", "block"};
    EventFinder finder(head, 1, {"reach", "lift"});
    for (int i = 0; i < 100; ++i) {
        frame::Frame f = held(i);
        f.phase = i < 50 ? 0 : 1;
        if (i >= 70 && i < 80) f.status = kRateLimited;
        if (i < 10) f.contacts.clear();
        if (i < 60) {
            frame::ContactFrame& table = f.contacts.emplace_back();
            table.a = 0;
            table.b = 1;
            table.normal_force = 1;
        }
        finder.add(f);
    }
    EXPECT_EQ(said_by(finder),
              (std::vector<std::string>{
                  "0 phase reach", "10 touch thumb block", "10 touch index block", "50 phase lift",
                  "60 lift-off block",
                  "70 limit a force or a torque was kept from changing faster than allowed"}));
}

TEST(Events, TellsWhatWasTunedOnceItHasArrived) {
    EventFinder finder({}, -1, {"all"});
    for (int i = 0; i < 100; ++i) {
        frame::Frame f;
        f.sequence = i;
        f.time = i * std::chrono::milliseconds(1);
        f.phase = 0;
        f.damping = kUnmeasured;
        f.stiffness = i < 20 ? 1000 : std::min(2000, 1000 + 50 * (i - 20));
        if (i >= 60) f.damping = 3;
        if (i == 80) f.status = kResumed;
        finder.add(f);
    }
    EXPECT_EQ(said_by(finder),
              (std::vector<std::string>{
                  "0 phase all", "41 setting coupling.stiffness_N_m: 1000 -> 2000",
                  "61 setting coupling.damping_Ns_m: k h / 2 -> 3", "80 went on after a pause"}));
}

}  // namespace
}  // namespace dihaptic::analysis::analysis_test
