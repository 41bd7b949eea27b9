// Tests sessions on the virtual clock that are watched by a window: their pace, pauses and single
// ticks, and that none of these changes the results.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "recording/raw_log.h"
#include "session/listeners/live.h"
#include "session/replay.h"
#include "session/test/reaches.h"

namespace dihaptic::session::pacing_test {
namespace {

using std::chrono::milliseconds;
using Wall = std::chrono::steady_clock;

/// Runs a session of two trials in its own thread.
struct Watched {
    Files files;
    Live live;
    RunResult result;
    std::atomic<bool> over{false};
    std::thread thread;

    Watched() { files.keep_first_block(); }
    ~Watched() {
        live.ended = true;
        join();
    }
    void start() {
        const Plan plan = make_plan(files.request());
        RunOptions options;
        options.out = files.folder.file("sessions");
        options.live = &live;
        thread = std::thread([this, plan, options] {
            result = run_session(plan, options, kGoOn, {});
            over = true;
        });
    }
    void join() {
        if (thread.joinable()) thread.join();
    }
    int64_t tick() { return live.frame.read().sequence; }
    /// Waits until a condition holds, but for at most ten seconds.
    template <class Condition>
    bool until(const Condition& condition) {
        for (int i = 0; i < 10000; ++i) {
            if (condition()) return true;
            std::this_thread::sleep_for(milliseconds(1));
        }
        return false;
    }
};

TEST(Pacing, KeepsThePaceThatIsAskedFor) {
    Watched session;
    session.live.pace = 5;
    const auto begin = Wall::now();
    session.start();
    session.join();
    const double took = std::chrono::duration<double>(Wall::now() - begin).count();
    // there is no upper bound, because a busy machine may be slower
    EXPECT_GE(took, session.result.simulated / 5 - 0.05);
    EXPECT_GT(session.result.simulated, 1);
}

TEST(Pacing, APauseAndSingleTicksChangeNothingOfWhatIsComputed) {
    Watched session;
    session.live.pace = 1;
    session.start();
    ASSERT_TRUE(session.until([&] { return session.tick() > 50; }));
    session.live.paused = true;
    std::this_thread::sleep_for(milliseconds(50));
    const int64_t held = session.live.frame.read().sequence;
    std::this_thread::sleep_for(milliseconds(100));
    EXPECT_EQ(session.tick(), held);
    session.live.steps = 8;
    EXPECT_TRUE(session.until([&] { return session.tick() >= held + 8; }));
    std::this_thread::sleep_for(milliseconds(20));
    // before the pause, a frame was published every 4 ms of session time
    EXPECT_LE(session.tick(), held + 12);
    session.live.pace = 0;
    session.live.paused = false;
    session.join();
    EXPECT_FALSE(session.result.interrupted);
    EXPECT_TRUE(replay_session(session.result.folder, kGoOn, {}).good());

    Files alone;
    alone.keep_first_block();
    const RunResult same = alone.run(make_plan(alone.request()));
    EXPECT_EQ(session.result.ticks, same.ticks);
    recording::RawLogReader one(session.result.folder + "/raw.log");
    recording::RawLogReader other(same.folder + "/raw.log");
    while (const frame::Frame* frame = one.next()) {
        const frame::Frame* twin = other.next();
        ASSERT_NE(twin, nullptr);
        ASSERT_EQ(outcome_of(*frame), outcome_of(*twin)) << "tick " << frame->sequence;
    }
}

TEST(Pacing, APausedSessionEndsWhenItIsAskedTo) {
    Watched session;
    session.live.paused = true;
    session.start();
    std::this_thread::sleep_for(milliseconds(50));
    EXPECT_FALSE(session.over);
    session.live.ended = true;
    session.join();
    EXPECT_TRUE(session.result.interrupted);
}

}  // namespace
}  // namespace dihaptic::session::pacing_test
