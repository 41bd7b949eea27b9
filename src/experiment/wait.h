// How long a trial has waited for what a simulated hand never does: without an end, such a session
// would fill the disk.
#pragma once

#include <string>
#include <vector>

#include "experiment/task_plan.h"
#include "recording/session.h"
#include "servo/servo.h"

namespace dihaptic::experiment {

class Wait {
  public:
    /// `stages`: of the task.
    explicit Wait(const std::vector<TaskPlan::Stage>& stages);

    /// In each tick, with what is to come in it.
    void look(const servo::Frame& last, const servo::Commands& commands) noexcept;
    /// It lasts too long: the session is to end.
    bool over() const noexcept { return over_; }
    /// What was waited for, and what to do. `phases`: the session's.
    std::string describe(const std::vector<recording::PhaseInfo>& phases) const;

  private:
    static constexpr double kLongestBetween = 60;  // trials [s]
    static constexpr double kLongest = 60;         // in a state, beyond its exit by time [s]
    static constexpr double kRounds = 10;          // through all states, in one attempt

    int trial_ = 0;
    int attempt_ = 0;
    int phase_ = 0;
    double since_ = 0;            // of the state [s]
    double begun_ = 0;            // of the attempt [s]
    double seen_ = 0;             // last [s]
    std::vector<double> bounds_;  // by phase [s]
    double attempt_bound_ = kLongestBetween;
    bool over_ = false;
};

}  // namespace dihaptic::experiment
