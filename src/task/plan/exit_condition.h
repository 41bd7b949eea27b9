// Plans the condition under which an exit is taken.
#pragma once

#include "task/plan/body_planner.h"

namespace dihaptic::task {

/// Returns the condition of an exit as an expression. It is empty if the exit is taken by key,
/// button, trigger, answer or time, and after an error. The plan's formulas must already be
/// compiled.
Expression plan_condition(const Planning& given, BodyPlanner& bodies, const Exit& exit);

}  // namespace dihaptic::task
