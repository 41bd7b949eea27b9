// Warns of what simulated people (src/person) cannot do in a task: a rehearsal would still run to
// its end and give figures that look like any other.
#pragma once

#include <vector>

#include "base/diagnostics.h"
#include "task/task_plan.h"

namespace dihaptic::person {

/// Warnings of force fields, which are taken for rotations, then of judgements of anything but
/// lengths, then of buttons; each kind in the file's order.
std::vector<Problem> simulated_limits(const task::TaskPlan& plan);

}  // namespace dihaptic::person
