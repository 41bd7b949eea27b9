// Tests bodies that states drive: along minimum-jerk paths and along expressions, until the states
// release the bodies.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/minimum_jerk.h"
#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/reaches.h"

namespace dihaptic::task::drive_test {
namespace {

using session::Mistake;

constexpr double kTick = 1e-3;

/// A scene with a platform next to the table.
struct WithPlatform : session::Files {
    WithPlatform() {
        scene.insert(scene.find("  - { name: block"),
                     "  - { name: platform, shape: box, size_mm: [60, 60, 20], position_mm: [200, "
                     "0, 100], driven: yes }\n");
    }
};

std::string state(const std::string& name, const std::string& next, const std::string& drive) {
    return "    - { name: " + name + ", exits: [{ when: time, after_s: 0.3, " + next +
           " }], drive: [" + drive + "], simulated_hand: [{ duration_s: 0.1 }] }\n";
}

/// Returns the frames of the first trial of an experiment with these states. Its recording must
/// replay exactly.
std::vector<frame::Frame> frames_of(session::Files& files, const std::string& states) {
    files.experiment = "scene: scene.yaml\nhand: { centre_mm: [0, 0, 220] }\ntask:\n  states:\n" +
                       states + "  blocks: [{ name: all, repeats: 2 }]\n";
    const session::RunResult result = files.run(session::make_plan(files.request()));
    EXPECT_FALSE(result.interrupted) << result.fault;
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
    std::vector<frame::Frame> out;
    recording::RawLogReader log(result.folder + "/raw.log");
    while (const frame::Frame* frame = log.next()) {
        if (frame->trial == 1 && frame->phase > 0 && frame->task.outcome < 0) out.push_back(*frame);
    }
    return out;
}

constexpr size_t kPlatform = 1, kBlock = 2;

TEST(Drive, GoesOnAMinimumJerkPathAndBack) {
    WithPlatform files;
    const auto frames = frames_of(
        files, state("up", "to: down",
                     "{ body: platform, by_mm: [0, 0, 50], duration_s: 0.2, delay_s: 0.05 }") +
                   state("down", "outcome: done",
                         "{ body: platform, to_mm: [200, 10, 100], duration_s: 0.3 }"));
    ASSERT_GT(frames.size(), 550u);
    int in_state = 0;
    int phase = 1;
    for (const frame::Frame& frame : frames) {
        in_state = frame.phase == phase ? in_state + 1 : 1;
        phase = frame.phase;
        if (frame.sequence < 1) continue;
        const double t = in_state * kTick;
        const Vec3& p = frame.bodies[kPlatform].X_WB.p;
        const double s = phase == 1
                             ? model::minimum_jerk(std::clamp((t - 0.05) / 0.2, 0.0, 1.0)).share
                             : 1 - model::minimum_jerk(std::min(t / 0.3, 1.0)).share;
        EXPECT_NEAR(p.z(), 0.1 + 0.05 * s, 2e-4) << phase << " " << t;
        EXPECT_EQ(frame.task.drives.size(), 1u);
        if (phase == 1) {
            EXPECT_EQ(p.y(), 0);
        }
    }
    EXPECT_LT((frames.back().bodies[kPlatform].X_WB.p - Vec3(0.2, 0.01, 0.1)).norm(), 1e-4);
}

TEST(Drive, ShakesAlongAnExpression) {
    WithPlatform files;
    const auto frames =
        frames_of(files, state("shake", "outcome: done",
                               "{ body: platform, along: [0, 0, 5 mm * sin(2 * 3.14159265358979 * "
                               "10 Hz * time_in_state)] }"));
    ASSERT_GT(frames.size(), 290u);
    double error = 0;
    for (size_t i = 10; i < frames.size(); ++i) {
        const double t = static_cast<double>(i) * kTick;
        const double z = frames[i].bodies[kPlatform].X_WB.p.z();
        error =
            std::max(error, std::abs(z - 0.1 - 0.005 * std::sin(2 * std::numbers::pi * 10 * t)));
    }
    EXPECT_LT(error, 0.005 * 2 * std::numbers::pi * 10 * 2 * kTick);
}

TEST(Drive, FollowsATable) {
    WithPlatform files;
    const auto frames = frames_of(
        files, state("follow", "outcome: done",
                     "{ body: platform, delay_s: 0.05, path: { times_s: [2, 2.1, 2.2], z_mm: [10, "
                     "40, 20], x_mm: [7, 7, 7] } }"));
    ASSERT_GT(frames.size(), 290u);
    const auto at = [&](double t) {
        return frames[static_cast<size_t>(std::lround(t / kTick))].bodies[kPlatform].X_WB.p;
    };
    EXPECT_LT((at(0.04) - Vec3(0.2, 0, 0.1)).norm(), 1e-12);
    // at a speed of up to 0.45 m/s, a state that begins one tick later or earlier shifts the
    // platform by the distance it moves in one tick
    EXPECT_NEAR(at(0.15).z(), 0.13, 1e-3);
    EXPECT_NEAR(at(0.2).z(), 0.1 + 0.03 - 0.01, 1e-3);  // halfway between slopes of 50 and 0 mm/s
    EXPECT_LT((at(0.28) - Vec3(0.2, 0, 0.11)).norm(), 1e-9);
}

TEST(Drive, FollowsAFileThatTheSessionKeeps) {
    WithPlatform files;
    files.folder.write("path.csv", "time_s,z_mm,y_mm\n0,0,100\n0.1,5,100\n0.2,20,90\n");
    const auto frames = frames_of(
        files, state("follow", "outcome: done", "{ body: platform, path: { file: path.csv } }"));
    ASSERT_GT(frames.size(), 290u);
    EXPECT_LT((frames[280].bodies[kPlatform].X_WB.p - Vec3(0.2, -0.01, 0.12)).norm(), 1e-9);
}

TEST(Drive, TurnsABodyAboutItsOriginWhileItGoes) {
    WithPlatform files;
    const auto frames = frames_of(
        files, state("tilt", "to: back",
                     "{ body: platform, axis: [0, 2, 0], angle_deg: 30, duration_s: 0.2 }") +
                   state("back", "outcome: done",
                         "{ body: platform, by_mm: [0, 0, 20], axis: [0, -1, 0], angle_deg: 30, "
                         "duration_s: 0.2 }"));
    ASSERT_GT(frames.size(), 550u);
    const Quat tilted(Eigen::AngleAxisd(std::numbers::pi / 6, Vec3::UnitY()));
    EXPECT_LT(frames[290].bodies[kPlatform].X_WB.R.angularDistance(tilted), 1e-6);
    EXPECT_LT((frames[290].bodies[kPlatform].X_WB.p - Vec3(0.2, 0, 0.1)).norm(), 1e-9);
    EXPECT_LT(frames.back().bodies[kPlatform].X_WB.R.angularDistance(Quat::Identity()), 1e-6);
    EXPECT_NEAR(frames.back().bodies[kPlatform].X_WB.p.z(), 0.12, 1e-6);
}

TEST(Drive, HandsABodyOverAndLetsItGo) {
    session::Files files;
    const auto frames =
        frames_of(files, state("hand over", "to: let go",
                               "{ body: block, to_mm: [100, 0, 200], duration_s: 0.25 }") +
                             state("let go", "outcome: done", ""));
    ASSERT_GT(frames.size(), 550u);
    EXPECT_LT((frames[290].bodies[1].X_WB.p - Vec3(0.1, 0, 0.2)).norm(), 1e-6);
    const double fallen = 0.2 - frames.back().bodies[1].X_WB.p.z();
    EXPECT_GT(fallen, 0.15);  // the block is back on the table
}

class BrokenDrive : public ::testing::TestWithParam<Mistake> {};

TEST_P(BrokenDrive, IsRefusedWithFileLineAndRemedy) {
    session::Files files;
    session::expect_refused(files, GetParam());
}

constexpr const char* kMarker = "      marker: 7\n";
INSTANTIATE_TEST_SUITE_P(
    Drive, BrokenDrive,
    ::testing::Values(
        Mistake{kMarker, "      drive: [{ by_mm: [0, 0, 90], duration_s: 1 }]\n",
                "body: is missing"},
        Mistake{kMarker, "      drive: [{ body: blok, by_mm: [0, 0, 9], duration_s: 1 }]\n",
                "Did you mean block?"},
        Mistake{kMarker, "      drive: [{ body: table, by_mm: [0, 0, 9], duration_s: 1 }]\n",
                "Write driven: yes there"},
        Mistake{kMarker, "      drive: [{ body: block }]\n", "gives no destination"},
        Mistake{
            kMarker,
            "      drive: [{ body: block, by_mm: [0, 0, 9], to_mm: [0, 0, 9], duration_s: 1 }]\n",
            "gives several destinations at once"},
        Mistake{kMarker, "      drive: [{ body: block, by_mm: [0, 0, 9] }]\n",
                "duration: is missing"},
        Mistake{kMarker, "      drive: [{ body: block, along: [0, 0] }]\n", "three expressions"},
        Mistake{kMarker, "      drive: [{ body: block, along: [0, 0, 2 N] }]\n",
                "does not have the dimension of length"},
        Mistake{kMarker, "      drive: [{ body: block, along: [0, 0, 3 mm], duration_s: 2 }]\n",
                "is only for to_mm, by_mm and angle_deg"},
        Mistake{kMarker, "      drive: [{ body: block, angle_deg: 9, duration_s: 2 }]\n",
                "axis: is missing"},
        Mistake{kMarker, "      drive: [{ body: block, along: [0, 0, 3 mm], axis: [0, 0, 1] }]\n",
                "cannot be combined with 'along'"},
        Mistake{kMarker, "      drive: [{ body: block, path: { times_s: [0], x_mm: [0] } }]\n",
                "has fewer than two times"},
        Mistake{kMarker,
                "      drive: [{ body: block, path: { times_s: [0, 1, 1], x_mm: [0, 1, 2] } }]\n",
                "does not ascend after item 2"},
        Mistake{kMarker,
                "      drive: [{ body: block, path: { times_s: [0, 1], x_mm: [0, 1, 2] } }]\n",
                "has 3 positions for 2 times"},
        Mistake{kMarker, "      drive: [{ body: block, path: { times_s: [0, 1] } }]\n",
                "and so are 'y' and 'z'"},
        Mistake{kMarker, "      drive: [{ body: block, path: { file: no.csv } }]\n",
                "is empty, or cannot be read"},
        Mistake{kMarker,
                "      drive: [{ body: block, path: { file: no.csv, times_s: [0, 1] } }]\n",
                "is given together with positions"},
        Mistake{
            kMarker,
            "      drive: [{ body: block, duration_s: 1, path: { times_s: [0, 1], x_mm: [0, 1] } "
            "}]\n",
            "is already given by the times"},
        Mistake{kMarker, "      drive: [{ body: block, along: [0, 0, indx.z] }]\n",
                "Did you mean index"},
        Mistake{kMarker,
                "      drive: [{ body: block, along: [0, 0, 3 mm] }]\n"
                "      place: [{ body: block, held: yes }]\n",
                "is driven or held twice"}));

}  // namespace
}  // namespace dihaptic::task::drive_test
