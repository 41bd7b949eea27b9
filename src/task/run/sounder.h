// Commands the start and end of a task's sounds in each tick. These commands are recorded
// (frame/task_frame.h). After construction, Sounder does not allocate, lock or throw.
#pragma once

#include "task/plan/task_plan.h"

namespace dihaptic::task {

class Sounder {
  public:
    /// `plan` must outlive this object.
    explicit Sounder(const TaskPlan& plan) : plan_(plan) {}

    /// Notes that a state starts.
    void enter(const TaskPlan::PlannedState& planned) noexcept {
        once_ |= planned.sounds & ~plan_.going_on;
    }
    /// Notes that a state is left through this transition.
    void take(const TaskPlan::Transition& transition) noexcept { once_ |= transition.sounds; }
    /// Adds the sound commands to `out`. Must be called once in each tick, at its end. `planned` is
    /// the trial's current state, or null if there is none.
    void order(const TaskPlan::PlannedState* planned, frame::TaskFrame& out) noexcept;

  private:
    const TaskPlan& plan_;
    uint32_t once_ = 0;   // sounds that start in this tick, one bit for each sound
    uint32_t going_ = 0;  // sounds that continue from an earlier tick, one bit for each sound
};

}  // namespace dihaptic::task
