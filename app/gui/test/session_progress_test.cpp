#include "session_progress.h"

#include <gtest/gtest.h>

namespace dihaptic::gui {
namespace {

session::Plan plan_of(const char* file, bool mouse = false) {
    session::Request request;
    request.file = file;
    request.mouse = mouse;
    request.participant = "S07";
    return session::make_plan(request);
}

frame::Frame at(double time) {
    frame::Frame frame;
    frame.time = from_seconds(time);
    return frame;
}

TEST(SessionProgress, OfAScriptIsItsPhaseAndWhatIsLeft) {
    const session::Plan plan = plan_of("experiments/lift-block.yaml");
    frame::Frame frame = at(plan.driver->duration() - 3);
    frame.phase = 0;
    const SessionProgress now = progress_of(plan, frame, 0, 1);
    EXPECT_EQ(now.trial, "");
    EXPECT_NEAR(now.share, 1 - 3 / plan.driver->duration(), 1e-9);
    EXPECT_EQ(now.text.toStdString(), plan.driver->phases()[0].name + ": 3 s left");
}

TEST(SessionProgress, ByAHandThatNobodyPlannedIsTheTime) {
    const SessionProgress now =
        progress_of(plan_of("scenes/block-on-table.yaml", true), at(75), 0, 1);
    EXPECT_EQ(now.share, 0);
    EXPECT_EQ(now.text, "1 min 15 s");
}

TEST(SessionProgress, OfTrialsIsWhichAndHowLongTheRestTakes) {
    const session::Plan plan = plan_of("experiments/visuomotor-rotation.yaml");
    frame::Frame frame = at(100);
    EXPECT_EQ(progress_of(plan, frame, 0, 1).text, "1 min 40 s");
    frame.trial = 3;
    frame.task.attempt = 2;
    const SessionProgress now = progress_of(plan, frame, 0.25, 1);
    EXPECT_EQ(now.trial, "Trial 3 of 504");
    EXPECT_TRUE(now.names.endsWith(" \u00b7 attempt 2")) << now.names.toStdString();
    EXPECT_EQ(now.share, 0.25);
    EXPECT_EQ(now.text, "about 5 min left");
    EXPECT_EQ(progress_of(plan, frame, 0.25, 10).text, "about 30 s left");
}

TEST(SessionProgress, OfTheRestOfASessionIsEstimatedFromItsOwnTrials) {
    const session::Plan plan = plan_of("experiments/visuomotor-rotation.yaml");
    const ProgressStart start{0, 0.5};
    EXPECT_EQ(progress_of(plan, at(100), 0.5, 1, start).text, "1 min 40 s");
    EXPECT_EQ(progress_of(plan, at(100), 0.6, 1, start).text, "about 7 min left");
}

TEST(SessionProgress, RoundsWhatIsEstimated) {
    EXPECT_EQ(roughly(3), "a few seconds");
    EXPECT_EQ(roughly(32.7), "35 s");
    EXPECT_EQ(roughly(58), "1 min");
    EXPECT_EQ(roughly(61), "1 min");
    EXPECT_EQ(roughly(580), "10 min");
    EXPECT_EQ(roughly(23 * 60), "25 min");
    EXPECT_EQ(roughly(60 * 60), "1 h");
    EXPECT_EQ(roughly(103 * 60), "1 h 45 min");
}

}  // namespace
}  // namespace dihaptic::gui
