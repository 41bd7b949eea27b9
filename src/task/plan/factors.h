// The factors of a task's conditions and rounds. Crossed, they make the conditions: each has one
// level of each factor, and a name joined from the levels, e.g. "200 suede". Conditions listed in
// the file can have levels too.
#pragma once

#include "task/file/task.h"

namespace dihaptic::task {

/// Generates the conditions of the task's `cross`, and merges the task's existing conditions into
/// them. A second call changes nothing. Problems go to `diagnostics`.
void cross_factors(Task& task, Diagnostics& diagnostics);

/// The factors of the conditions, then those of the rounds, each with the levels that occur, in
/// order of occurrence.
std::vector<Factor> factors_of(const Task& task);

/// The level of a factor in a condition or a round; empty if it has none.
std::string level_of(const Condition& condition, const std::string& factor);
/// The conditions, or the rounds, to which the factor belongs.
const std::vector<Condition>& owners_of(const Task& task, const std::string& factor);

}  // namespace dihaptic::task
