// Runs a simulated person in a shipped experiment that a test may modify, and passes each Frame to
// the test.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "person/person.h"
#include "person/population.h"
#include "servo/run.h"
#include "session/record.h"
#include "task/run/task_director.h"
#include "testing/files.h"

namespace dihaptic::person {

inline const std::atomic<bool> kGoOn{false};

/// The text of a shipped experiment, which tests can modify and turn into a plan. Tests must run in
/// the project folder.
struct Sitting {
    testing::TemporaryFolder folder;
    std::string text;

    explicit Sitting(const std::string& name)
        : text(testing::read_file("experiments/" + name + ".yaml")) {
        const std::string here = std::filesystem::current_path().string();
        for (size_t at = 0; (at = text.find("../", at)) != std::string::npos;)
            text.replace(at, 3, here + "/");
    }
    void replace(const std::string& what, const std::string& by) {
        const size_t at = text.find(what);
        ASSERT_NE(at, std::string::npos) << what;
        text.replace(at, what.size(), by);
    }
    /// Replaces everything from the text `from` to the end with `by`.
    void end_with(const std::string& from, const std::string& by) {
        const size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        text = text.substr(0, at) + by;
    }
    session::Plan plan(uint64_t seed = 1) {
        session::Request request;
        request.file = folder.write("experiment.yaml", text);
        request.simulate = true;
        request.seed = seed;
        request.participant = "S01";
        return session::make_plan(request);
    }
};

/// Runs the plan's trials in the same way as a session, but without recording anything.
inline void run_trials(const session::Plan& plan, const frame::FrameSink& sink) {
    const auto servo = session::make_servo(plan);
    servo->activate();
    plan.seeing->restart();
    task::TaskDirector task(*plan.task, plan.seed, plan.settings.tick());
    const frame::Director director = [&](const frame::Frame& last,
                                         std::span<const frame::Handle> handles,
                                         frame::Commands& commands) {
        if (const char key = plan.seeing->take_key(); key != 0) task.press(key);
        task(last, handles, commands);
    };
    const frame::FrameSink see = [&](const frame::Frame& frame) {
        plan.seeing->see(frame);
        sink(frame);
    };
    servo::run_virtual(*servo, director, see, std::chrono::hours(2), kGoOn, nullptr);
}

}  // namespace dihaptic::person
