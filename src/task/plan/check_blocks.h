// Checks a task's procedures and blocks: the trials that they make, and the perturbations that
// these trials have, each and together.
#pragma once

#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// Reports what is wrong with them. The plan must have its outcomes, formulas and cells.
void check_blocks(const TaskPlan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::task
