// Runs a session's task in its servo loop, and checks that no tick allocates memory.
#pragma once

#include <gtest/gtest.h>

#include "session/plan.h"
#include "task/run/task_director.h"
#include "testing/allocation_guard.h"

namespace dihaptic::session {

/// Also checks that the task is done within `longest` [s]. `between` controls the trials.
inline void expect_no_allocation(const Plan& plan, double longest,
                                 task::TrialControl* between = nullptr) {
    const auto servo = make_servo(plan);
    task::TaskDirector task(*plan.task, plan.seed, plan.settings.tick());
    if (between != nullptr) task.decide_by(*between);
    plan.seeing->restart();
    servo->activate();
    const frame::Director director =
        [&](const frame::Frame& last, std::span<const frame::Handle> handles,
            frame::Commands& commands) { task(last, handles, commands); };
    Time now{0};
    const testing::AllocationGuard guard;
    while (!servo->stopped() && seconds(now) < longest) {
        plan.seeing->see(servo->tick(now, director));
        now += servo->period();
    }
    EXPECT_EQ(guard.count(), 0u);
    EXPECT_EQ(task.share(), 1);
}

}  // namespace dihaptic::session
