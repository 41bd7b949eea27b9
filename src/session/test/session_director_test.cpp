// Tests what a session's director adds to the orders of the trials, without running a session.
#include "session/session_director.h"

#include "session/test/reaches.h"

namespace dihaptic::session::session_director_test {
namespace {

struct Bench {
    Files files;
    Plan plan = make_plan(files.request());
    std::unique_ptr<servo::Servo> servo = make_servo(plan);
    RunOptions options;
    std::atomic<bool> stop{false};
    recording::SessionInfo info;
    const recording::SessionFolder folder =
        recording::SessionFolder::create(files.folder.path(), "directed");
    frame::Frame last;

    Bench() {
        for (const scene::Body& body : plan.scene.bodies)
            last.bodies.emplace_back().X_WB = body.pose();
        last.fingers.resize(1);
        last.fingers[0].p_WP = {0, 0, 0.12};
    }
    Opening session() const {
        return {plan, options, folder, info, *servo, options.clock == Clock::real};
    }
    frame::Commands order(SessionDirector& director) {
        const frame::Handle handle{{0, 0, 0.12}};
        frame::Commands commands;
        director(last, {&handle, 1}, commands);
        return commands;
    }
};

TEST(SessionDirector, TakesForceAwayAtTheOperatorsStopOnTheRealClockOnly) {
    Bench bench;
    bench.stop = true;
    for (const Clock clock : {Clock::virtual_clock, Clock::real}) {
        bench.options.clock = clock;
        SessionDirector director(bench.session(), bench.stop, {});
        EXPECT_EQ(bench.order(director).force_off, clock == Clock::real);
    }
}

TEST(SessionDirector, DoesAsTheWatchingThreadAsks) {
    Bench bench;
    Live live;
    live.prepare(*bench.servo, bench.plan.scene);
    bench.options.clock = Clock::real;
    SessionDirector director(bench.session(), bench.stop, {&live});
    EXPECT_FALSE(bench.order(director).rest);
    live.paused = true;
    EXPECT_TRUE(bench.order(director).rest);
    EXPECT_FALSE(bench.order(director).stop);
    live.ended = true;
    EXPECT_TRUE(bench.order(director).stop);
    EXPECT_TRUE(director.trials_left());
    EXPECT_EQ(director.endless_wait({}), "");
}

}  // namespace
}  // namespace dihaptic::session::session_director_test
