// Orders the start and end of a task's sounds in each tick. The orders are recorded
// (frame/task_frame.h). Once constructed, it neither allocates, locks nor throws.
#pragma once

#include "task/plan/task_plan.h"

namespace dihaptic::task {

class Sounder {
  public:
    /// `plan` must outlive the object.
    explicit Sounder(const TaskPlan& plan) : plan_(plan) {}

    /// Starts a state.
    void enter(const TaskPlan::PlannedState& planned) noexcept {
        once_ |= planned.sounds & ~plan_.going_on;
    }
    /// Takes an exit of a state.
    void take(const TaskPlan::Transition& transition) noexcept { once_ |= transition.sounds; }
    /// Call once in each tick, at its end. `planned`: the trial's current state; null: none.
    void order(const TaskPlan::PlannedState* planned, frame::TaskFrame& out) noexcept;

  private:
    const TaskPlan& plan_;
    uint32_t once_ = 0;   // sounds that start in this tick, one bit each
    uint32_t going_ = 0;  // sounds that continue from an earlier tick
};

}  // namespace dihaptic::task
