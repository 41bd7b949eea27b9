// What simulated people (src/person) cannot do of a task: a rehearsal of it runs to the end and
// gives figures that look like any other.
#pragma once

#include <vector>

#include "base/diagnostics.h"
#include "experiment/task_plan.h"

namespace dihaptic::experiment {

/// Warnings, in the file's order: force fields, which are taken for rotations; judgements of
/// anything but lengths; buttons.
std::vector<Problem> simulated_limits(const TaskPlan& plan);

}  // namespace dihaptic::experiment
