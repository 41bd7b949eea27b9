// The factors that a task's conditions differ by. Crossed, they make the conditions: each has one
// level of each factor, and their names joined as its name, e.g. "200 suede". Conditions that are
// written by hand may have levels too.
#pragma once

#include "task/file/task.h"

namespace dihaptic::task {

/// Makes the conditions of the task's `cross`, those that the task has already with what they add.
/// Done twice, it changes nothing. Problems go to `diagnostics`.
void cross_factors(Task& task, Diagnostics& diagnostics);

/// The factors that conditions have levels of, each with the levels that occur, in their order.
std::vector<Factor> factors_of(const Task& task);

/// The condition's level of a factor; empty if it has none.
std::string level_of(const Condition& condition, const std::string& factor);

}  // namespace dihaptic::task
