// Checks a task's procedures and blocks: their trials, and the perturbations in these trials, both
// individually and in combination.
#pragma once

#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// Reports mistakes in the plan's procedures and blocks. The plan's outcomes, formulas and cells
/// must have been planned.
void check_blocks(const TaskPlan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::task
