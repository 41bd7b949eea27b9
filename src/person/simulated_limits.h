// Warns of abilities that a task requires but simulated people (src/person) do not have. Without
// the warning, a rehearsal would still run to its end, and its figures would look like any others.
#pragma once

#include <vector>

#include "base/diagnostics.h"
#include "task/plan/task_plan.h"

namespace dihaptic::person {

/// Returns the warnings, ordered by kind and, within a kind, as in the file: force fields that no
/// reach meets, delays, shifts and links, thresholds and answers that are not judgements of length,
/// ratings, motors that push, and buttons.
std::vector<Problem> simulated_limits(const task::TaskPlan& plan);

}  // namespace dihaptic::person
