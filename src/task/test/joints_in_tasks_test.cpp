// Tests tasks that name joints: trials that begin with them displaced, and conditions on them.
#include <gtest/gtest.h>

#include <cmath>

#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/reaches.h"

namespace dihaptic::task::joints_in_tasks_test {
namespace {

using session::Mistake;

constexpr double kLength = 0.1;
constexpr double kGravity = 9.81;

/// A lamp that hangs from a beam on a string of two rods, and a drawer.
struct Jointed : session::Files {
    Jointed() {
        scene.insert(scene.find("fingers:"),
                     "  - { name: upper, shape: sphere, radius_mm: 1, mass_g: 50, position_mm: "
                     "[200, 0, 400] }\n"
                     "  - { name: lower, shape: sphere, radius_mm: 1, mass_g: 50, position_mm: "
                     "[200, 0, 300] }\n"
                     "  - { name: box, shape: box, size_mm: [20, 20, 20], mass_g: 50, "
                     "position_mm: [-200, 0, 200] }\n");
        scene +=
            "joints:\n"
            "  - { name: shoulder, kind: hinge, between: [upper], position_mm: [200, 0, 500], "
            "axis: [0, -1, 0] }\n"
            "  - { name: elbow, kind: hinge, between: [upper, lower], position_mm: [200, 0, 400], "
            "axis: [0, -1, 0] }\n"
            "  - { name: drawer, kind: slider, between: [box], position_mm: [-200, 0, 200], "
            "axis: [0, 2, 0], friction_N: 0.1 }\n"
            "  - { name: weld, kind: fixed, between: [block, table] }\n";
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
    EXPECT_EQ(log.head().joints, (std::vector<std::string>{"shoulder", "elbow", "drawer", "weld"}));
    const double start = 20 * M_PI / 180;
    const Vec3 down(std::sin(start), 0, -std::cos(start));
    double last = start;
    bool first = true;
    double passed = 0;
    while (const servo::Frame* frame = log.next()) {
        if (frame->phase == 0) continue;
        if (first) {  // a step of gravity later
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
        // what hangs below pulls at the hinge in the world's frame: about its weight
        EXPECT_GT(frame->joints[0].f_B_W.z(), 0.5 * 0.1 * kGravity);
        last = frame->joints[0].angle;
        passed += 1e-3;
    }
    EXPECT_FALSE(first);
    EXPECT_LT(last, 0.01);
    // a straight double pendulum of equal masses falls as one at first: between the quarter periods
    // of its two modes, 2 pi sqrt(l / (2 -+ sqrt 2) / g) / 4
    const double mode = M_PI / 2 * std::sqrt(kLength / kGravity);
    EXPECT_GT(passed, mode / std::sqrt(2 + std::sqrt(2.0)));
    EXPECT_LT(passed, 1.2 * mode / std::sqrt(2 - std::sqrt(2.0)) + 0.1);
}

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
        Mistake{kPlace, "{ joint: shoulder }", "is what a hinge has"},
        Mistake{kPlace, "{ joint: shoulder, body: upper, angle_deg: 20 }", "Keep one of the two."},
        Mistake{kPlace, "{ body: upper, angle_deg: 20 }", "belongs to a joint"},
        Mistake{kPlace, "{ body: upper }", "is missing"},
        Mistake{kPlace, "{ position_mm: [0, 0, 100] }", "is missing"},
        Mistake{kPlace, "{ joint: shoulder, angle_mm: 20 }", "angle"},
        Mistake{"shoulder.angle < 0 deg", "shoulder.angle < 0 mm", "the other in m"},
        Mistake{"shoulder.angle", "shoulder.angel", "Did you mean shoulder.angle?"}));

}  // namespace
}  // namespace dihaptic::task::joints_in_tasks_test
