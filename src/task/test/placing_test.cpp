// Tests states that place, hold, release, remove and exchange bodies.
#include <gtest/gtest.h>

#include <map>

#include "base/text_file.h"
#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/reaches.h"

namespace dihaptic::task::placing_test {
namespace {

using session::Mistake;

constexpr double kTick = 1e-3;
constexpr double kGravity = 9.81;

/// Returns a state that lasts 0.1 s and leads to another state or to the end of the trial.
std::string state(const std::string& name, const std::string& next, const std::string& more) {
    return "    - { name: " + name + ", exits: [{ when: time, after_s: 0.1, " + next + " }]" +
           more + " }\n";
}

/// Returns the frames of the first trial of an experiment with these states, except the first frame
/// of the session, in which no state has placed anything yet.
std::vector<frame::Frame> frames_of(session::Files& files, const std::string& states) {
    files.experiment = "scene: scene.yaml\nhand: { centre_mm: [0, 0, 220] }\ntask:\n  states:\n" +
                       states + "  blocks: [{ name: all, repeats: 2 }]\n";
    const session::RunResult result = files.run(session::make_plan(files.request()));
    EXPECT_FALSE(result.interrupted) << result.fault;
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
    std::vector<frame::Frame> out;
    recording::RawLogReader log(result.folder + "/raw.log");
    while (const frame::Frame* frame = log.next()) {
        if (frame->trial == 1 && frame->sequence > 0 && frame->task.outcome < 0)
            out.push_back(*frame);
    }
    return out;
}

TEST(Placing, HoldsABodyAndLetsItGo) {
    session::Files files;
    const auto frames =
        frames_of(files, state("hold", "to: drop",
                               ", place: [{ body: block, position_mm: [100, 0, 300], held: yes }], "
                               "simulated_hand: [{ duration_s: 0.1 }]") +
                             state("drop", "outcome: done", ""));
    double t = 0;
    for (const frame::Frame& frame : frames) {
        const double z = frame.bodies[1].X_WB.p.z();
        EXPECT_NEAR(frame.bodies[1].X_WB.p.x(), 0.1, 1e-9);
        EXPECT_EQ(frame.task.placements.size(), frame.phase == 1 ? 1u : 0u);
        t += frame.phase == 2 ? kTick : 0;
        EXPECT_NEAR(z, 0.3 - kGravity * t * t / 2, frame.phase == 1 ? 1.1e-5 : 2e-3) << t;
    }
    EXPECT_NEAR(t, 0.1, 2e-3);
}

TEST(Placing, IsMissedWhereAFingerIsInTheWay) {
    session::Files files;
    files.experiment = "scene: scene.yaml\nhand: { centre_mm: [0, 0, 220] }\ntask:\n  states:\n" +
                       state("hold", "to: drop",
                             ", place: [{ body: block, position_mm: [0, 0, 220], held: yes }], "
                             "simulated_hand: [{ duration_s: 0.1 }]") +
                       state("drop", "outcome: done", "") +
                       "  blocks: [{ name: all, repeats: 2 }]\n";
    const session::RunResult result = files.run(session::make_plan(files.request()));
    const std::string info = read_text_file(result.folder + "/session.yaml");
    EXPECT_NE(info.find("2 placements in a state did not take place"), std::string::npos) << info;
    EXPECT_NE(info.find("block in the state 'hold' of trial 2"), std::string::npos) << info;
}

TEST(Placing, RemovesAndExchangesBodies) {
    session::Files files;
    files.scene.insert(files.scene.find("fingers:"),
                       "  - { name: ball, shape: sphere, radius_mm: 20, mass_g: 100, position_mm: "
                       "[200, 0, 20] }\n");
    const auto frames = frames_of(
        files,
        state("one", "to: other",
              ", place: [{ body: ball, removed: yes }], "
              "simulated_hand: [{ duration_s: 0.1 }]") +
            state("other", "outcome: done",
                  ", place: [{ body: block, removed: yes }, { body: ball, position_mm: [0, 0, "
                  "20] }]"));
    ASSERT_GT(frames.size(), 150u);
    for (const frame::Frame& frame : frames) {
        const frame::BodyFrame& here = frame.bodies[frame.phase == 1 ? 1 : 2];
        const frame::BodyFrame& away = frame.bodies[frame.phase == 1 ? 2 : 1];
        EXPECT_LT((here.X_WB.p - Vec3(0, 0, 0.02)).norm(), 1e-4) << frame.phase;
        EXPECT_GT(away.X_WB.p.z(), 900);
    }
}

TEST(Placing, WaitsForAFingerThatIsInTheWay) {
    session::Files files;
    const auto frames = frames_of(
        files,
        "    - name: in the way\n"
        "      place: [{ body: block, position_mm: [0, 0, 220], held: yes }]\n"
        "      exits: [{ when: time, after_s: 0.8, to: away }]\n"
        "      simulated_hand: [{ duration_s: 0.1 }, { duration_s: 0.5, move_mm: [0, 0, 150] }]\n" +
            state("away", "outcome: done", ""));
    ASSERT_GT(frames.size(), 850u);
    size_t put = 0;
    for (const frame::Frame& frame : frames) {
        EXPECT_EQ(frame.fingers[0].f_contact_W, Vec3::Zero());
        if (frame.task.placements.empty()) continue;
        EXPECT_EQ(frame.phase, 1);
        if (put++ == 0) {
            EXPECT_GT(frame.fingers[0].p_WP.z(), 0.25);
        }
    }
    EXPECT_GT(put, 200u);
    EXPECT_LT(put, 600u);
}

/// A scene with a fixed wall.
struct Walled : session::Files {
    Walled() {
        scene.insert(scene.find("  - { name: block"),
                     "  - { name: wall, shape: box, size_mm: [10, 100, 100], position_mm: [200, 0, "
                     "50], fixed: yes }\n");
    }
};

TEST(Placing, PutsAFixedBodyWhereAConditionHasItAndBackWhereTheOtherDoesNot) {
    Walled files;
    files.experiment =
        "scene: scene.yaml\nhand: { centre_mm: [0, 0, 220] }\ntask:\n"
        "  draws: [{ name: gap_mm, uniform: { from: 40, to: 90 } }]\n"
        "  states:\n" +
        state("wait", "outcome: done", ", simulated_hand: [{ duration_s: 0.1 }]") +
        "  conditions:\n    - name: near\n      places: [{ body: wall, position_mm: [-gap, 0, 50] "
        "}]\n    - name: far\n"
        "  blocks: [{ name: all, repeats: 3, order: sequential }]\n";
    const session::Plan plan = session::make_plan(files.request());
    const session::RunResult result = files.run(plan);
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
    std::map<std::string, int> ticks;
    recording::RawLogReader log(result.folder + "/raw.log");
    while (const frame::Frame* frame = log.next()) {
        if (frame->trial < 1 || frame->phase == 0) continue;
        const Trial& trial = plan.task->trials[static_cast<size_t>(frame->trial) - 1];
        const bool near =
            plan.task->task.conditions[static_cast<size_t>(trial.condition)].name == "near";
        const Vec3 expected(near ? -1e-3 * trial.draws[0] : 0.2, 0, 0.05);
        EXPECT_LT((frame->bodies[1].X_WB.p - expected).norm(), 1e-9) << frame->trial;
        ++ticks[near ? "near" : "far"];
    }
    EXPECT_GT(ticks["near"], 250);
    EXPECT_GT(ticks["far"], 250);
}

TEST(Placing, IsByFormulasOfTheTrialAndOfFixedBodiesToo) {
    Walled files;
    files.experiment =
        "scene: scene.yaml\nhand: { centre_mm: [0, 0, 220] }\ntask:\n"
        "  draws: [{ name: gap_mm, uniform: { from: 40, to: 90 } }]\n"
        "  states:\n" +
        state(
            "out", "to: back",
            ", place: [{ body: wall, position_mm: [0, gap, 50] }, { body: block, removed: yes }], "
            "simulated_hand: [{ duration_s: 0.1 }]") +
        state("back", "outcome: done",
              ", place: [{ body: wall, removed: yes }, { body: block, position_mm: [0, 2 * gap, "
              "20] }]") +
        "  blocks: [{ name: all, repeats: 3 }]\n";
    const session::Plan plan = session::make_plan(files.request());
    const session::RunResult result = files.run(plan);
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
    recording::RawLogReader log(result.folder + "/raw.log");
    int seen = 0;
    while (const frame::Frame* frame = log.next()) {
        if (frame->trial < 1 || frame->phase == 0 || frame->sequence < 2) continue;
        const double gap = 1e-3 * plan.task->trials[static_cast<size_t>(frame->trial) - 1].draws[0];
        const Vec3& wall = frame->bodies[1].X_WB.p;
        const Vec3& block = frame->bodies[2].X_WB.p;
        if (frame->phase == 1) {
            EXPECT_LT((wall - Vec3(0, gap, 0.05)).norm(), 1e-9);
            EXPECT_GT(block.z(), 900);
        } else {
            EXPECT_GT(wall.z(), 900);
            EXPECT_LT((block - Vec3(0, 2 * gap, 0.02)).norm(), 1e-4);
        }
        ++seen;
    }
    EXPECT_GT(seen, 550);
}

class BrokenPlace : public ::testing::TestWithParam<Mistake> {};

TEST_P(BrokenPlace, IsRefusedWithFileLineAndRemedy) {
    session::Files files;
    session::expect_refused(files, GetParam());
}

constexpr const char* kMarker = "      marker: 7\n";
INSTANTIATE_TEST_SUITE_P(
    Placing, BrokenPlace,
    ::testing::Values(
        Mistake{kMarker, "      place: [{ position_mm: [0, 0, 90] }]\n", "body: is missing"},
        Mistake{kMarker, "      place: [{ body: blok, held: yes }]\n", "Did you mean block?"},
        Mistake{kMarker, "      place: [{ body: table, held: yes }]\n", "stays in place anyway"},
        Mistake{kMarker, "      place: [{ body: block, position_mm: [1, 0, index.x] }]\n",
                "depends on a quantity that changes within a trial"},
        Mistake{kMarker, "      place: [{ body: block }]\n",
                "position: is missing, and so is any other key"},
        Mistake{kMarker, "      place: [{ body: block, position: [0, 0, 9] }]\n", "needs its unit"},
        Mistake{kMarker, "      place: [{ body: block, removed: yes, held: yes }]\n",
                "cannot be combined with 'position' or 'held'"},
        Mistake{kMarker,
                "      place: [{ body: block, held: yes }, { body: block, removed: yes }]\n",
                "is placed twice"},
        Mistake{kMarker, "      place: { body: block, held: yes }\n", "must be a list"}));

}  // namespace
}  // namespace dihaptic::task::placing_test
