// Tests the shipped scenes that contain things to handle, with the fingers of each scene's script:
// doors open, drawers slide, scissors close, balls bounce and swing, soft things yield.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/unit.h"
#include "session/plan.h"
#include "session/session_run.h"
#include "testing/files.h"

namespace dihaptic::session::things_test {
namespace {

/// Calls f(frame) for each tick while the script of a scene runs.
void play(const std::string& scene, const std::function<void(const frame::Frame&)>& f) {
    const testing::TemporaryFolder folder;
    Request request;
    request.file = "scenes/" + scene + ".yaml";
    RunOptions options;
    options.out = folder.path();
    options.in_place_of_log = [&](const auto&, const auto&, const auto&) -> frame::FrameSink {
        return [&](const frame::Frame& frame) { f(frame); };
    };
    std::atomic<bool> stop{false};
    const RunResult result = run_session(make_plan(request), options, stop, {});
    EXPECT_TRUE(result.fault.empty()) << result.fault;
}

double seconds_of(const frame::Frame& frame) {
    return std::chrono::duration<double>(frame.time).count();
}

/// Returns the smaller of the two forces with which the fingers press on what they hold.
double grip_of(const frame::Frame& frame) {
    return std::min(frame.fingers[0].f_contact_W.norm(), frame.fingers[1].f_contact_W.norm());
}

TEST(Things, ADrawerIsPulledOpenAndStays) {
    double most = 0;
    double last = 0;
    play("drawer", [&](const frame::Frame& frame) {
        most = std::max(most, last = frame.joints[0].displacement);
        EXPECT_GE(last, -1e-6);
    });
    EXPECT_GT(most, 0.08);
    // a spring of 5 N/m pulls the drawer back in until friction of 0.4 N holds it
    EXPECT_LT(last, 0.081);
    EXPECT_GT(last, 0.04);
}

TEST(Things, ADoorIsOpenedByItsHandleAndItsHingesStayTogether) {
    double most = 0;
    play("door", [&](const frame::Frame& frame) {
        most = std::max(most, frame.joints[0].angle);
        for (size_t i = 1; i < 3; ++i) {
            EXPECT_NEAR(frame.joints[i].angle, frame.joints[0].angle, 1e-6);
            EXPECT_LT(frame.joints[i].f_B_W.norm(), 50);
        }
    });
    EXPECT_GT(most, 15 * kDegree);
}

TEST(Things, APendulumIsLetGoAndSwings) {
    double longest = 0;
    double least = 1;
    double most = -1;
    play("pendulum", [&](const frame::Frame& frame) {
        longest = std::max(longest, frame.joints[0].displacement);
        if (seconds_of(frame) < 3) return;
        least = std::min(least, frame.bodies[2].X_WB.p.y());
        most = std::max(most, frame.bodies[2].X_WB.p.y());
    });
    EXPECT_LT(longest, 0.230 + 1e-6);  // the string
    EXPECT_LT(least, -0.03);
    EXPECT_GT(most, 0.02);
}

TEST(Things, ScissorsCloseAndOpen) {
    double most = 0;
    double last = 0;
    play("scissors", [&](const frame::Frame& frame) {
        last = frame.joints[0].angle;
        most = std::max(most, last);
    });
    EXPECT_GT(most, 10 * kDegree);
    EXPECT_LT(last, 5 * kDegree);
}

TEST(Things, ASpringBetweenTwoPlatesIsFelt) {
    double stretch = 0;
    double grip = 0;
    play("spring-between-plates", [&](const frame::Frame& frame) {
        if (seconds_of(frame) < 2.3 || seconds_of(frame) > 2.4) return;
        stretch = frame.joints[0].displacement;
        grip = grip_of(frame);
    });
    EXPECT_LT(stretch, -0.005);
    // the weak spring that keeps the left plate centred also contributes
    EXPECT_NEAR(grip / (-200 * stretch), 1, 0.1);
}

TEST(Things, APoleFallsOver) {
    double most = 0;
    play("pole", [&](const frame::Frame& frame) {
        most = std::max(most, std::abs(frame.joints[0].angle));
        EXPECT_LT(std::abs(frame.joints[0].angle), 60.5 * kDegree);
    });
    EXPECT_GT(most, 20 * kDegree);
}

TEST(Things, ASpongeGivesWayWhereAStoneDoesNot) {
    double sponge = 1;
    double stone = 1;
    const auto between = [](const frame::Frame& frame) {
        return (frame.fingers[1].p_WP - frame.fingers[0].p_WP).norm() - 0.005;
    };
    play("sponge-and-stone", [&](const frame::Frame& frame) {
        if (grip_of(frame) < 0.5) return;
        double& least = seconds_of(frame) < 4 ? sponge : stone;
        least = std::min(least, between(frame));
    });
    EXPECT_LT(sponge, 0.038);
    EXPECT_GT(stone, 0.0399);
}

TEST(Things, ABallBouncesOnARacketLowerEachTime) {
    std::vector<double> heights;
    double before = 0;
    play("bouncing-ball", [&](const frame::Frame& frame) {
        if (seconds_of(frame) > 1) return;  // the racket moves after this
        const double v = frame.bodies[2].v_WB.z();
        if (before > 0 && v <= 0)
            heights.push_back(frame.bodies[2].X_WB.p.z() - frame.bodies[1].X_WB.p.z() - 0.041);
        before = v;
    });
    ASSERT_GE(heights.size(), 2u);
    EXPECT_NEAR(heights[0], 0.64 * 0.2, 0.02 * 0.128);
    for (size_t i = 1; i < heights.size(); ++i) EXPECT_LT(heights[i], 0.7 * heights[i - 1]);
}

TEST(Things, ATowerStandsWhenABarIsPulledOut) {
    double out = 0;
    double roof = 1;
    play("tower", [&](const frame::Frame& frame) {
        out = frame.bodies[5].X_WB.p.y();
        roof = std::min(roof, frame.bodies[7].X_WB.p.z());
    });
    EXPECT_LT(out, -0.09);
    EXPECT_GT(roof, 0.037);
}

}  // namespace
}  // namespace dihaptic::session::things_test
