// Tests, with every solver, that what the hand does with blocks in the shipped experiments obeys
// mechanics.
#include <gtest/gtest.h>

#include <numbers>

#include "recording/raw_log.h"
#include "session/record.h"
#include "testing/files.h"

namespace dihaptic::session::skills_test {
namespace {

using analysis::Episode;
using rows::EpisodeKind;

constexpr double kGravity = 9.81;

class Skills : public ::testing::TestWithParam<contact::Solver> {
  protected:
    std::vector<Episode> run(const std::string& experiment) {
        Request request;
        request.file = "experiments/" + experiment + ".yaml";
        request.set = {"dynamics.solver=" + std::string(enum_name(GetParam()))};
        RunOptions options;
        options.out = folder.path();
        const std::atomic<bool> go_on{false};
        const Recorded recorded = record(make_plan(request), options, go_on);
        session = recorded.folder;
        figures = recorded.figures;
        EXPECT_FALSE(figures.failed());
        EXPECT_EQ(figures.ticks_with(kForceLimited), 0);
        return figures.episodes;
    }
    double end() const { return figures.duration - 2 * figures.tick; }

    testing::TemporaryFolder folder;
    std::string session;
    analysis::SessionFigures figures;
};
INSTANTIATE_TEST_SUITE_P(Session, Skills,
                         ::testing::Values(contact::Solver::sequential_impulse,
                                           contact::Solver::stewart_trinkle,
                                           contact::Solver::staggered_projections,
                                           contact::Solver::newton),
                         [](const auto& of) { return std::string(enum_name(of.param)); });

TEST_P(Skills, ABlockThatIsPushedFeelsFrictionAndSlidesOnAsFarAsItLets) {
    const auto found = run("slide-block");
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].kind, EpisodeKind::slide);
    EXPECT_EQ(found[0].finger_names, "index");
    EXPECT_GT(found[0].distance, 0.2);
    EXPECT_NEAR(found[0].friction_ratio, 1, 0.005);
    EXPECT_EQ(found[1].kind, EpisodeKind::slide);
    EXPECT_EQ(found[1].finger_names, "");
    EXPECT_GT(found[1].distance, 0.03);
    EXPECT_NEAR(found[1].friction_ratio, 1, 0.001);
}

TEST_P(Skills, ABlockRollsOnTheFingertipsThatTurnIt) {
    const auto found = run("turn-block");
    ASSERT_EQ(found.size(), 1u);
    const Episode& hold = found[0];
    EXPECT_EQ(hold.finger_names, "thumb, index");
    EXPECT_GT(hold.hand_turn, 0.5);
    const double r = 0.006;
    const double w = 0.02;
    EXPECT_NEAR(hold.hand_turn / (hold.turn - std::atan(r * hold.turn / (w + r))), 1, 0.001);
    EXPECT_NEAR(hold.slip, r * hold.turn,
                1e-5);  // the distance that the fingers have rolled, but nothing more
    EXPECT_GT(hold.sag, -1e-6);
}

TEST_P(Skills, ABlockIsTossedAtTheHandsSpeedFliesBallisticallyAndIsCaught) {
    const auto found = run("toss-block");
    ASSERT_EQ(found.size(), 3u);
    const Episode& flight = found[1];
    EXPECT_EQ(flight.kind, EpisodeKind::flight);
    EXPECT_EQ(flight.finger_names, "thumb, index");
    EXPECT_NEAR(flight.release_ratio, 1, 0.02);
    EXPECT_GT(flight.release_speed, 0.9);
    EXPECT_LT(flight.off_path, 1e-9);
    EXPECT_NEAR(flight.rise, flight.release_speed * flight.release_speed / (2 * kGravity), 2e-3);
    const Episode& caught = found[2];
    EXPECT_EQ(caught.kind, EpisodeKind::hold);
    EXPECT_EQ(caught.finger_names, "thumb, index");
    EXPECT_LT(caught.slip, 1e-3);
    EXPECT_GE(caught.end, end());
}

TEST_P(Skills, ABlockThatIsDroppedIsCaughtByTheOtherHand) {
    const auto found = run("catch-block");
    ASSERT_EQ(found.size(), 3u);
    const Episode& fall = found[1];
    EXPECT_EQ(fall.kind, EpisodeKind::flight);
    EXPECT_EQ(fall.finger_names, "right_thumb, right_index");
    EXPECT_GT(fall.end - fall.start, 0.08);
    EXPECT_LT(fall.off_path, 1e-9);
    const Episode& caught = found[2];
    EXPECT_EQ(caught.kind, EpisodeKind::hold);
    EXPECT_EQ(caught.finger_names, "left_thumb, left_index");
    EXPECT_LT(caught.slip, 3e-3);
    EXPECT_GE(caught.end, end());
}

TEST_P(Skills, ABlockChangesHandsWithoutFalling) {
    const auto found = run("hand-over");
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].finger_names, "right_thumb, right_index");
    EXPECT_EQ(found[1].finger_names, "right_thumb, right_index, left_thumb, left_index");
    EXPECT_EQ(found[2].finger_names, "left_thumb, left_index");
    EXPECT_LT(found[0].slip, 1e-6);
    EXPECT_LT(found[1].least_slip, 1e-6);
    EXPECT_LT(found[2].slip, 1e-6);
    // the block's weight is transferred to the springs of the other hand and of its coupling
    double before = 0;
    double after = 0;
    recording::RawLogReader log(session + "/raw.log");
    while (const frame::Frame* frame = log.next()) {
        const double z = frame->bodies[1].X_WB.p.z();
        if (frame->time < std::chrono::milliseconds(2000)) before = z;
        if (frame->time < std::chrono::milliseconds(4500)) after = z;
    }
    const double k = 1 / (1 / 300.0 + 1 / 1000.0);
    EXPECT_NEAR((before - after) / (0.1 * kGravity / (2 * k)), 1, 0.05);
}

TEST_P(Skills, ABlockOnASpatulaIsFeltAsItsWeightTimesItsDistance) {
    const auto found = run("lift-on-spatula");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].kind, EpisodeKind::hold);
    EXPECT_LT(found[0].slip, 1e-4);
    // level, then tilted by 10 degrees; the weight turns the spatula further
    for (const double when : {2.9, 4.9}) {
        recording::RawLogReader log(session + "/raw.log");
        const frame::Frame* frame = log.next();
        while (seconds(frame->time) < when) frame = log.next();
        const double distance = frame->bodies[3].X_WB.p.x() - frame->fingers[0].p_WH.x();
        const Vec3& torque = frame->turns.at(0).t_sent_W;
        EXPECT_NEAR(torque.y() / (0.1 * kGravity * distance), 1, 0.005) << when;
        EXPECT_LT(std::hypot(torque.x(), torque.z()), 1e-4);
        EXPECT_NEAR(frame->fingers[0].f_sent_W.z() / (-0.1 * kGravity), 1, 0.005);
        // the torque turns both the hand and the coupling, with 1 N*m/rad each
        const double tilt = rotation_vector(frame->fingers[0].R_WP).y();
        const double script = when > 4 ? 10 * std::numbers::pi / 180 : 0;
        EXPECT_NEAR(tilt - script, 2 * torque.y(), 1e-3);
    }
}

}  // namespace
}  // namespace dihaptic::session::skills_test
