// Orders, tick by tick, which of a task's sounds begin and end. What it orders is recorded
// (frame/task_frame.h). Once constructed it neither allocates, locks nor throws.
#pragma once

#include "task/plan/task_plan.h"

namespace dihaptic::task {

class Sounder {
  public:
    /// `plan` must outlive the object.
    explicit Sounder(const TaskPlan& plan) : plan_(plan) {}

    /// A state begins.
    void enter(const TaskPlan::Stage& stage) noexcept { once_ |= stage.sounds & ~plan_.going_on; }
    /// A way out of a state is taken.
    void take(const TaskPlan::Way& way) noexcept { once_ |= way.sounds; }
    /// Call once in each tick, at its end. `stage`: the state that the trial is in; null: none.
    void order(const TaskPlan::Stage* stage, frame::TaskFrame& out) noexcept;

  private:
    const TaskPlan& plan_;
    uint32_t once_ = 0;   // begin in this tick, one bit each
    uint32_t going_ = 0;  // go on since an earlier tick
};

}  // namespace dihaptic::task
