// The factors of a task's conditions and rounds. Crossing the factors generates the conditions:
// each condition has one level of each factor, and its name is joined from the levels, e.g. "200
// suede". Conditions listed in the file can have levels too.
#pragma once

#include "task/file/task.h"

namespace dihaptic::task {

/// Generates conditions from the task's `cross`, and merges the task's existing conditions into
/// them. Calling this function again changes nothing. Problems are added to `diagnostics`.
void cross_factors(Task& task, Diagnostics& diagnostics);

/// Returns the factors of the conditions, followed by those of the rounds. The levels of each
/// factor are listed in order of first occurrence.
std::vector<Factor> factors_of(const Task& task);

/// Returns the level of a factor in a condition or round, or "" if it has no level of this factor.
std::string level_of(const Condition& condition, const std::string& factor);
/// Returns the task's conditions or its rounds, depending on which of them have the factor.
const std::vector<Condition>& owners_of(const Task& task, const std::string& factor);

}  // namespace dihaptic::task
