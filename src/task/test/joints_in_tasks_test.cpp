// Tests tasks that use joints: trials that begin with displaced joints, conditions on joints,
// springs that differ between trials, and motors.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/reaches.h"

namespace dihaptic::task::joints_in_tasks_test {
namespace {

using session::Mistake;

constexpr double kLength = 0.1;
constexpr double kGravity = 9.81;

/// A scene with a lamp that hangs from a beam on a string of two rods, and with a drawer.
struct Jointed : session::Files {
    Jointed() {
        scene.insert(scene.find("fingers:"),
                     "  - { name: upper, shape: sphere, radius_mm: 1, mass_g: 50, position_mm: "
                     "[200, 0, 400] }\n"
                     "  - { name: lower, shape: sphere, radius_mm: 1, mass_g: 50, position_mm: "
                     "[200, 0, 300] }\n"
                     "  - { name: box, shape: box, size_mm: [20, 20, 20], mass_g: 50, "
                     "position_mm: [-200, 0, 200] }\n"
                     "  - { name: pan, shape: box, size_mm: [20, 20, 20], mass_g: 50, "
                     "position_mm: [-200, 100, 200] }\n");
        scene +=
            "joints:\n"
            "  - { name: shoulder, kind: hinge, between: [upper], position_mm: [200, 0, 500], "
            "axis: [0, -1, 0] }\n"
            "  - { name: elbow, kind: hinge, between: [upper, lower], position_mm: [200, 0, 400], "
            "axis: [0, -1, 0] }\n"
            "  - { name: drawer, kind: slider, between: [box], position_mm: [-200, 0, 200], "
            "axis: [0, 2, 0], friction_N: 0.1 }\n"
            "  - { name: weld, kind: fixed, between: [block, table] }\n"
            "  - { name: scale, kind: slider, between: [pan], position_mm: [-200, 100, 200], "
            "axis: [0, 0, 1], stiffness_N_m: 50, damping_Ns_m: 3 }\n";
    }
    /// Writes a task whose state has the keys `what`, with a perturbation and its conditions, if
    /// given.
    void does(const std::string& what, const std::string& perturbation = "",
              const std::string& conditions = "") {
        experiment = "scene: scene.yaml\nhand: { centre_mm: [0, 0, 220] }\ntask:\n" +
                     (perturbation.empty() ? "" : "  perturbations: [" + perturbation + "]\n") +
                     "  states:\n"
                     "    - name: work\n"
                     "      simulated_hand: [{ duration_s: 0.1 }]\n"
                     "      " +
                     what +
                     "\n"
                     "      exits: [{ when: time, after_s: 1, outcome: done }]\n" +
                     conditions + "  blocks: [{ name: all, order: sequential" +
                     (perturbation.empty() ? "" : ", kind: perturbed, perturb: changed") + " }]\n";
    }
    /// Runs the session, which must replay exactly. Returns the frame of each trial's last tick in
    /// the state.
    std::vector<frame::Frame> last_frames() {
        const session::RunResult result = run(session::make_plan(request()));
        EXPECT_FALSE(result.interrupted) << result.fault;
        EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
        std::vector<frame::Frame> out;
        recording::RawLogReader log(result.folder + "/raw.log");
        int trial = 0;
        while (const frame::Frame* frame = log.next()) {
            if (frame->phase != 1 || frame->task.outcome >= 0) continue;
            if (frame->trial != trial) out.emplace_back();
            trial = frame->trial;
            out.back() = *frame;
        }
        return out;
    }
    void conditions(const std::string& list) {
        experiment =
            "scene: scene.yaml\nhand: { centre_mm: [0, 0, 220] }\ntask:\n"
            "  states:\n"
            "    - name: swing\n"
            "      simulated_hand: [{ duration_s: 0.1 }]\n"
            "      exits:\n"
            "        - { when: shoulder.angle < 0 deg, outcome: through }\n"
            "        - { when: time, after_s: 0.5, outcome: late }\n"
            "  conditions:\n" +
            list + "  blocks: [{ name: all }]\n";
    }
};

TEST(JointsInTasks, BeginWhereATrialSaysWithAllThatHangsOnThem) {
    Jointed files;
    files.conditions(
        "    - { name: one, factors: { swing_deg: 20 }, places: [{ joint: shoulder, angle_deg: "
        "swing }, { joint: drawer, displacement_mm: 30 }] }\n");
    const session::RunResult result = files.run(session::make_plan(files.request()));
    ASSERT_FALSE(result.interrupted) << result.fault;
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
    recording::RawLogReader log(result.folder + "/raw.log");
    EXPECT_EQ(log.head().joints,
              (std::vector<std::string>{"shoulder", "elbow", "drawer", "weld", "scale"}));
    const double start = 20 * M_PI / 180;
    const Vec3 down(std::sin(start), 0, -std::cos(start));
    double last = start;
    bool first = true;
    double passed = 0;
    while (const frame::Frame* frame = log.next()) {
        if (frame->phase == 0) continue;
        if (first) {  // gravity has acted for one step
            EXPECT_LT((frame->bodies[2].X_WB.p - Vec3(0.2, 0, 0.5) - kLength * down).norm(), 1e-5);
            EXPECT_LT((frame->bodies[3].X_WB.p - Vec3(0.2, 0, 0.5) - 2 * kLength * down).norm(),
                      1e-5);
            EXPECT_NEAR(frame->joints[0].angle, start, 1e-4);
            EXPECT_NEAR(frame->joints[1].angle, 0, 1e-4);
            EXPECT_TRUE(std::isnan(frame->joints[0].displacement));
            first = false;
        }
        EXPECT_NEAR(frame->joints[2].displacement, 0.03, 1e-6);
        EXPECT_TRUE(std::isnan(frame->joints[3].angle));
        // the parts below the hinge pull on it with about their weight; the force is in the world
        // frame
        EXPECT_GT(frame->joints[0].f_B_W.z(), 0.5 * 0.1 * kGravity);
        last = frame->joints[0].angle;
        passed += 1e-3;
    }
    EXPECT_FALSE(first);
    EXPECT_LT(last, 0.01);
    // a straight double pendulum with equal masses first falls as one piece, in a time between the
    // quarter periods of its two modes, 2 pi sqrt(l / (2 -+ sqrt 2) / g) / 4
    const double mode = M_PI / 2 * std::sqrt(kLength / kGravity);
    EXPECT_GT(passed, mode / std::sqrt(2 + std::sqrt(2.0)));
    EXPECT_LT(passed, 1.2 * mode / std::sqrt(2 - std::sqrt(2.0)) + 0.1);
}

constexpr size_t kShoulder = 0, kDrawer = 2, kScale = 4;

TEST(JointsInTasks, HaveTheSpringsThatTrialsGiveThem) {
    Jointed files;
    files.does("lines: []", "{ name: changed, joint: { joint: scale, stiffness_scale: k } }",
               "  cross: [{ factor: k, levels: [0.5, 1, 4] }]\n");
    const std::vector<frame::Frame> last = files.last_frames();
    ASSERT_EQ(last.size(), 3u);
    const double sag = 0.05 * kGravity / 50;
    for (size_t i = 0; i < 3; ++i) {
        const double k = std::array{0.5, 1.0, 4.0}[i];
        EXPECT_NEAR(last[i].joints[kScale].displacement, -sag / k, 1e-4) << k;
        ASSERT_EQ(last[i].task.joint_properties.size(), 1u);
        EXPECT_EQ(last[i].task.joint_properties[0].stiffness_scale, k);
        EXPECT_EQ(last[i].task.joint_properties[0].damping_scale, 1);
    }
}

TEST(JointsInTasks, AreMovedByMotors) {
    Jointed files;
    files.does(
        "motors: [{ joint: drawer, displacement_mm: 40, duration_s: 0.5, most_force_N: 2 }, "
        "{ joint: shoulder, follow: 30 deg * sin(6.2831853 * time_in_state / (1 s)), "
        "most_torque_Nm: 1 }, { joint: scale, push: 2 N * time_in_state / (1 s) }]");
    const std::vector<frame::Frame> last = files.last_frames();
    ASSERT_EQ(last.size(), 1u);
    const frame::Frame& end = last[0];
    EXPECT_NEAR(end.joints[kDrawer].displacement, 0.04, 1e-6);
    EXPECT_NEAR(end.joints[kShoulder].angle, 0, 5e-3);  // after one period of the sine
    EXPECT_NEAR(end.joints[kShoulder].angular_velocity, 30 * M_PI / 180 * 2 * M_PI, 0.02);
    EXPECT_NEAR(end.joints[kScale].displacement, (2 - 0.05 * kGravity) / 50, 3e-3);
    ASSERT_EQ(end.task.motors.size(), 3u);
    EXPECT_EQ(end.task.motors[0].most_force, 2);
    EXPECT_EQ(end.task.motors[2].follows, 0u);
    EXPECT_NEAR(end.task.motors[2].push, 2, 5e-3);
}

TEST(JointsInTasks, BeginWhereTheyArePlacedAlsoWithMotors) {
    Jointed files;
    files.does("motors: [{ joint: shoulder, angle_deg: 60, duration_s: 0.8, most_torque_Nm: 1 }]",
               "", "  conditions: [{ name: one, places: [{ joint: shoulder, angle_deg: 30 }] }]\n");
    const session::RunResult result = files.run(session::make_plan(files.request()));
    ASSERT_FALSE(result.interrupted) << result.fault;
    recording::RawLogReader log(result.folder + "/raw.log");
    double least = 1e3, most = -1e3;
    while (const frame::Frame* frame = log.next()) {
        if (frame->phase != 1) continue;
        least = std::min(least, frame->joints[kShoulder].angle);
        most = std::max(most, frame->joints[kShoulder].angle);
    }
    EXPECT_NEAR(least, 30 * M_PI / 180, 1e-3);
    EXPECT_NEAR(most, 60 * M_PI / 180, 1e-3);
}

TEST(JointsInTasks, StayWhereAnExpressionHasNoValue) {
    Jointed files;
    files.does(
        "motors: [{ joint: shoulder, follow: 10 deg / (time_in_state - time_in_state) * (1 s), "
        "most_torque_Nm: 1, push: 1 Nm * (0 / share) }]",
        "", "  conditions: [{ name: one, places: [{ joint: shoulder, angle_deg: 30 }] }]\n");
    const std::vector<frame::Frame> last = files.last_frames();
    ASSERT_EQ(last.size(), 1u);
    EXPECT_NEAR(last[0].joints[kShoulder].angle, 30 * M_PI / 180, 1e-3);
    EXPECT_EQ(last[0].task.motors[0].push, 0);
}

TEST(JointsInTasks, BeginWithTheRateThatATrialSays) {
    Jointed files;
    files.does(
        "lines: []", "",
        "  conditions: [{ name: one, factors: { turn_deg_s: 90 }, places: [{ joint: shoulder, "
        "angle_deg: 10, rate_deg_s: turn }, { joint: scale, displacement_mm: -10, "
        "speed_mm_s: -50 }, { body: block, position_mm: [0, 0, 300], velocity_mm_s: [0, 0, "
        "500] }] }]\n");
    files.scene.replace(files.scene.find("  - { name: weld"), 1, "#");
    const session::RunResult result = files.run(session::make_plan(files.request()));
    ASSERT_FALSE(result.interrupted) << result.fault;
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
    recording::RawLogReader log(result.folder + "/raw.log");
    const frame::Frame* frame = log.next();
    while (frame != nullptr && frame->phase != 1) frame = log.next();
    ASSERT_NE(frame, nullptr);
    const double rate = 90 * M_PI / 180;
    EXPECT_NEAR(frame->joints[kShoulder].angular_velocity, rate, 0.03);
    EXPECT_NEAR(frame->joints[1].angular_velocity, 0, 0.05);  // the elbow stays straight
    EXPECT_NEAR(frame->bodies[3].v_WB.norm(), 2 * kLength * rate, 0.01);
    EXPECT_NEAR(frame->joints[3].velocity, -0.05,
                0.02);  // its spring and damper have acted for one step
    EXPECT_NEAR(frame->bodies[1].v_WB.z(), 0.5 - kGravity * 1e-3, 1e-6);
}

TEST(JointsInTasks, AndBodiesAreThrownByStates) {
    session::Files files;
    files.experiment =
        "scene: scene.yaml\nhand: { centre_mm: [0, 0, 220] }\ntask:\n  states:\n"
        "    - { name: hold, place: [{ body: block, position_mm: [0, 0, 100], held: yes }], "
        "simulated_hand: [{ duration_s: 0.1 }], exits: [{ when: time, after_s: 0.2, to: throw }] "
        "}\n"
        "    - { name: throw, place: [{ body: block, velocity_mm_s: [100, 0, 1000] }], "
        "simulated_hand: [{ duration_s: 0.1 }], exits: [{ when: time, after_s: 0.1, outcome: done "
        "}] }\n"
        "  blocks: [{ name: all }]\n";
    const session::RunResult result = files.run(session::make_plan(files.request()));
    ASSERT_FALSE(result.interrupted) << result.fault;
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
    recording::RawLogReader log(result.folder + "/raw.log");
    Vec3 last = Vec3::Zero();
    int ticks = 0;
    while (const frame::Frame* frame = log.next()) {
        if (frame->phase != 2) continue;
        last = frame->bodies[1].X_WB.p;
        ++ticks;
    }
    const double t = 1e-3 * ticks;
    EXPECT_NEAR(last.x(), 0.1 * t, 1e-6);
    EXPECT_NEAR(last.z(), 0.1 + t - kGravity * t * (t + 1e-3) / 2, 1e-5);
}

class MistakenMotor : public ::testing::TestWithParam<Mistake> {};

TEST_P(MistakenMotor, IsRefusedWithFileLineAndRemedy) {
    Jointed files;
    files.does(
        "motors: [{ joint: drawer, displacement_mm: 40, duration_s: 0.5, most_force_N: 2 }, "
        "{ joint: shoulder, follow: 30 deg * share, most_torque_Nm: 1, push: 1 Nm * share }]",
        "{ name: changed, joint: { joint: scale, stiffness_scale: 2 } }");
    session::expect_refused(files, GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    JointsInTasks, MistakenMotor,
    ::testing::Values(
        Mistake{"joint: drawer,", "joint: draw,", "Did you mean drawer?"},
        Mistake{"joint: drawer,", "joint: weld,", "Name a hinge, a slider or a distance joint."},
        Mistake{"joint: drawer,", "joint: shoulder,", "Keep one motor"},
        Mistake{"displacement_mm: 40", "angle_deg: 40", "Give displacement_mm instead."},
        Mistake{"displacement_mm: 40, ", "", "is only for a motor with displacement"},
        Mistake{"displacement_mm: 40, duration_s: 0.5, most_force_N: 2", "most_force_N: 2",
                "is missing, and so are 'follow' and 'push'"},
        Mistake{"duration_s: 0.5, ", "", "Add e.g. duration_s: 0.8."},
        Mistake{"duration_s: 0.5, ", "duration_s: 0.5, follow: 1 mm, ", "gives a second course"},
        Mistake{", most_force_N: 2", "", "Limit the motor"},
        Mistake{"most_force_N: 2", "most_torque_Nm: 2", "does not act on a slider"},
        Mistake{"30 deg * share", "30 mm * share", "does not have the dimension of angle"},
        Mistake{"1 Nm * share", "1 N * share", "does not have the dimension of torque"},
        Mistake{"joint: scale", "joint: scales", "Did you mean scale?"},
        Mistake{"stiffness_scale: 2", "friction_scale: 2", "has no friction to change"},
        Mistake{"joint: scale, stiffness_scale: 2", "joint: weld, damping_scale: 2",
                "has no damping to change"},
        Mistake{"stiffness_scale: 2", "stiffness_scale: -1", "stiffness_scale"}));

class MistakenJoint : public ::testing::TestWithParam<Mistake> {};

TEST_P(MistakenJoint, IsRefusedWithFileLineAndRemedy) {
    Jointed files;
    files.conditions("    - { name: one, places: [{ joint: shoulder, angle_deg: 20 }] }\n");
    session::expect_refused(files, GetParam());
}

const char* const kPlace = "{ joint: shoulder, angle_deg: 20 }";

INSTANTIATE_TEST_SUITE_P(
    JointsInTasks, MistakenJoint,
    ::testing::Values(
        Mistake{kPlace, "{ joint: sholder, angle_deg: 20 }", "Did you mean shoulder?"},
        Mistake{kPlace, "{ joint: shoulder, displacement_mm: 20 }", "Give angle_deg alone."},
        Mistake{kPlace, "{ joint: drawer, angle_deg: 20 }", "Give displacement_mm alone."},
        Mistake{kPlace, "{ joint: weld, angle_deg: 20 }", "has no axis"},
        Mistake{kPlace, "{ joint: shoulder, angle_deg: 20, speed_mm_s: 20 }",
                "Give rate_deg_s instead."},
        Mistake{kPlace, "{ joint: drawer, displacement_mm: 20, rate_deg_s: 20 }",
                "Give speed_mm_s instead."},
        Mistake{kPlace, "{ joint: shoulder, angle_deg: 20, velocity_mm_s: [1, 0, 0] }",
                "is only for a body"},
        Mistake{kPlace, "{ body: upper, position_mm: [0, 0, 9], rate_deg_s: 20 }",
                "is only for a joint"},
        Mistake{kPlace, "{ joint: shoulder }", "is the only coordinate of a hinge"},
        Mistake{kPlace, "{ joint: shoulder, body: upper, angle_deg: 20 }",
                "Keep either 'joint' or 'body'."},
        Mistake{kPlace, "{ body: upper, angle_deg: 20 }", "is only for a joint"},
        Mistake{kPlace, "{ body: upper }", "is missing"},
        Mistake{kPlace, "{ position_mm: [0, 0, 100] }", "is missing"},
        Mistake{kPlace, "{ joint: shoulder, angle_mm: 20 }", "angle"},
        Mistake{"shoulder.angle < 0 deg", "shoulder.angle < 0 mm", "but the other is in m"},
        Mistake{"shoulder.angle", "shoulder.angel", "Did you mean shoulder.angle?"}));

}  // namespace
}  // namespace dihaptic::task::joints_in_tasks_test
