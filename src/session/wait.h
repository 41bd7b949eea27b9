// Ends a session in which a trial waits for an action that its simulated hand never performs: such
// a session would continue until it had filled the disk.
#pragma once

#include <string>
#include <vector>

#include "recording/session.h"
#include "servo/servo.h"
#include "task/plan/task_plan.h"

namespace dihaptic::session {

class Wait {
  public:
    explicit Wait(const task::TaskPlan& plan);

    /// Call in each tick, with the last frame and the commands for this tick.
    void look(const frame::Frame& last, const frame::Commands& commands) noexcept;
    /// Whether the wait is too long and the session must end.
    bool over() const noexcept { return over_; }
    /// Describes the wait and the remedy. `phases`: the session's phases; `in_the_way`: a sentence
    /// about the finger that kept an object from being put back.
    std::string describe(const std::vector<recording::PhaseInfo>& phases,
                         const std::string& in_the_way) const;

  private:
    static constexpr double kLongestBetween = 60;  // between trials [s]
    static constexpr double kLongest = 60;         // in a state, beyond its exit by time [s]
    static constexpr double kRounds = 10;          // rounds of all states in one attempt

    int trial_ = 0;
    int attempt_ = 0;
    int phase_ = 0;
    double since_ = 0;            // when the state began [s]
    double begun_ = 0;            // when the attempt began [s]
    double seen_ = 0;             // time of the last frame [s]
    std::vector<double> bounds_;  // longest time in each phase [s]
    double attempt_bound_;
    bool over_ = false;
};

}  // namespace dihaptic::session
