// Tests how the window's thread, working or hanging, affects the force of a session that runs in
// another thread.
#include "session_runner.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QElapsedTimer>
#include <QThread>

#include "answer_until.h"
#include "recording/raw_log.h"
#include "testing/files.h"

namespace dihaptic::gui {
namespace {

class SessionRunnerTest : public ::testing::Test {
  protected:
    SessionRunnerTest() {
        QObject::connect(&runner_, &SessionRunner::ended, &runner_,
                         [this](const SessionEnd& end) { end_ = end; });
        session::Request request;
        request.file = "scenes/block-on-table.yaml";
        request.mouse = true;
        request.set = {"safety.max_pause_ms=1000"};  // long enough even on a busy machine
        session::RunOptions options;
        options.out = folder_.path();
        options.clock = session::Clock::real;
        runner_.start(session::make_plan(request), options, 1);
    }

    void answer_for(int ms) {
        QElapsedTimer timer;
        timer.start();
        EXPECT_TRUE(answer_until([&] { return timer.elapsed() >= ms; }));
    }
    double now() {
        const frame::Frame& frame = runner_.read_frame();
        return frame.sequence < 0 ? -1 : seconds(frame.time);
    }
    void grip() {
        ASSERT_TRUE(answer_until([&] { return now() > 0.1; }));
        hand::Posture goal = runner_.plan().mouse->goal();
        goal.aperture = 0.034;
        runner_.plan().mouse->follow(goal);
        answer_for(700);
        ASSERT_GT(runner_.read_frame().grip_force, 0.3);
    }
    /// Waits for the end of the session, and returns its frames.
    std::vector<frame::Frame> end() {
        EXPECT_TRUE(answer_until([&] { return !runner_.running(); }));
        std::vector<frame::Frame> frames;
        recording::RawLogReader log(end_.folder.toStdString() + "/raw.log");
        while (const frame::Frame* frame = log.next()) frames.push_back(*frame);
        return frames;
    }

    int words_ = 1;
    char name_[2] = "t";
    char* argument_ = name_;
    QCoreApplication app_{words_, &argument_};
    testing::TemporaryFolder folder_;
    std::atomic<bool> stop_{false};
    SessionRunner runner_{stop_};
    SessionEnd end_;
};

TEST_F(SessionRunnerTest, AWindowThatHangsBeforeItsFirstPictureTakesForceAwayToo) {
    grip();
    QThread::msleep(6500);  // force is switched off 1 s after the 5 s allowed for the first picture
    EXPECT_NE(runner_.read_frame().status & kForceOff, 0u);
    QString told;
    ASSERT_TRUE(answer_until([&] { return !(told = runner_.take_told()).isEmpty(); }));
    EXPECT_TRUE(told.contains("the window has not answered for 1.")) << told.toStdString();
    runner_.end();
    end();
}

TEST_F(SessionRunnerTest, AHungWindowTakesForceAwayAndTheSessionWaitsForIt) {
    runner_.watch();
    grip();
    const double before = now();
    QThread::msleep(2500);  // the window's thread hangs
    const frame::Frame& frame = runner_.read_frame();
    EXPECT_NE(frame.status & kForceOff, 0u);
    EXPECT_EQ(frame.fingers[0].f_sent_W, Vec3::Zero());
    QString told;
    ASSERT_TRUE(answer_until([&] { return !(told = runner_.take_told()).isEmpty(); }));
    EXPECT_TRUE(told.contains("the window has not answered for 1.")) << told.toStdString();
    EXPECT_TRUE(runner_.paused());
    const double waits = now();
    answer_for(200);
    EXPECT_EQ(now(), waits);
    runner_.set_paused(false);
    ASSERT_TRUE(answer_until([&] { return now() > waits + 0.5; }));
    EXPECT_EQ(runner_.read_frame().status & kForceOff, 0u);
    runner_.end();
    for (const frame::Frame& f : end()) {
        if ((f.status & kAbandoned) == 0) continue;
        EXPECT_GT(seconds(f.time), before + 0.8);  // the last beat was at most 0.1 s earlier
        EXPECT_LT(seconds(f.time), before + 1.2);
    }
}

TEST_F(SessionRunnerTest, APauseFromAnotherThreadTakesForceAwayThoughTheWindowHangs) {
    runner_.watch();
    grip();
    int told = 0;
    QObject::connect(&runner_, &SessionRunner::paused_at_once, [&] { ++told; });
    const auto pause_twice = [] {
        SessionRunner::pause_at_once();
        SessionRunner::pause_at_once();
    };
    const double before = now();
    std::thread(pause_twice).join();
    QThread::msleep(200);  // the window's thread hangs
    EXPECT_NE(runner_.read_frame().status & kPaused, 0u);
    EXPECT_EQ(runner_.frame().fingers[0].f_sent_W, Vec3::Zero());
    EXPECT_LT(now(), before + 0.1);
    EXPECT_EQ(told, 0);
    answer_for(50);
    EXPECT_EQ(told, 1);
    runner_.end();
    for (const frame::Frame& f : end()) EXPECT_EQ(f.status & kAbandoned, 0u);
    SessionRunner::pause_at_once();  // when no session is running
    answer_for(50);
    EXPECT_EQ(told, 1);
}

TEST_F(SessionRunnerTest, AStopFromOutsideTakesForceAwayAndEndsInOrder) {
    runner_.watch();
    grip();
    const double before = now();
    stop_ = true;
    const std::vector<frame::Frame> frames = end();
    ASSERT_FALSE(frames.empty());
    const frame::Frame& last = frames.back();
    EXPECT_NE(last.status & kStopped, 0u);
    EXPECT_EQ(last.fingers[0].f_sent_W, Vec3::Zero());
    EXPECT_LT(seconds(last.time), before + 0.1);
    EXPECT_FALSE(end_.good);
}

}  // namespace
}  // namespace dihaptic::gui
