// Warns of abilities that a task requires and simulated people (src/person) lack. A rehearsal would
// still run to its end, and give figures that look like any others.
#pragma once

#include <vector>

#include "base/diagnostics.h"
#include "task/plan/task_plan.h"

namespace dihaptic::person {

/// Warnings, kind by kind and each kind in the file's order: force fields that no reach meets,
/// delays, shifts and links, thresholds and answers that are not judgements of length, ratings,
/// motors that push, and buttons.
std::vector<Problem> simulated_limits(const task::TaskPlan& plan);

}  // namespace dihaptic::person
