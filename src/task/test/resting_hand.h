// Runs the director of a task by itself, tick after tick, while one hand rests and nothing moves in
// the world.
#pragma once

#include <vector>

#include "session/plan.h"
#include "task/run/task_director.h"

namespace dihaptic::task::test {

struct RestingHand {
    TaskDirector director;
    frame::Frame last;
    frame::Handle handle;
    frame::Commands commands;

    explicit RestingHand(const session::Plan& plan, const std::vector<Attempt>& done = {},
                         const Vec3& p_WH = {0, 0, 0.12})
        : director(*plan.task, plan.seed, 1e-3, done), handle{p_WH} {
        last.fingers.resize(1);
        last.fingers[0].p_WP = p_WH;
        for (const scene::Body& body : plan.scene.bodies)
            last.bodies.emplace_back().X_WB = body.pose();
        last.task.reserve({last.bodies.size()});
        commands.task.reserve({last.bodies.size()});
    }

    /// Runs the next tick and returns the director's commands.
    const frame::Commands& tick() {
        last.task = commands.task;
        commands.clear();
        director(last, std::span(&handle, 1), commands);
        last.sequence += 1;
        last.time += std::chrono::milliseconds(1);
        return commands;
    }
};

}  // namespace dihaptic::task::test
