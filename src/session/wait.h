// Ends a session in which a trial waits for an action that its simulated hand never performs.
// Without this check, the session would continue until the disk is full.
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

    /// Must be called in each tick, with the last frame and the commands for this tick.
    void look(const frame::Frame& last, const frame::Commands& commands) noexcept;
    /// Whether the wait has become too long, so that the session must end.
    bool over() const noexcept { return over_; }
    /// Describes the wait and the remedy. `phases` are the session's phases. `in_the_way` is a
    /// sentence about a finger that kept an object from being put back.
    std::string describe(const std::vector<recording::PhaseInfo>& phases,
                         const std::string& in_the_way) const;

  private:
    static constexpr double kLongestBetween = 60;  // longest wait between trials [s]
    static constexpr double kLongest = 60;         // longest wait in a state after its time-out [s]
    static constexpr double kRounds = 10;          // most rounds of all states in one attempt

    int trial_ = 0;
    int attempt_ = 0;
    int phase_ = 0;
    double since_ = 0;            // session time when the state began [s]
    double begun_ = 0;            // session time when the attempt began [s]
    double seen_ = 0;             // time of the last frame [s]
    std::vector<double> bounds_;  // longest duration of each phase [s]
    double attempt_bound_;
    bool over_ = false;
};

}  // namespace dihaptic::session
