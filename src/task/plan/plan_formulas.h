// What the formulas of a task may name, and their compiling, for its plan.
#pragma once

#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// Defines the task's draws, factors and variables in plan.quantities, compiles the formulas of
/// plan.task, and says in them which they are.
void plan_formulas(TaskPlan& plan, Diagnostics& diagnostics);

/// Compiles the rules after trials and the ends of blocks. The plan must have its outcomes.
void plan_rules(TaskPlan& plan, Diagnostics& diagnostics);

/// A text as the formula of a number that is named with its unit, e.g. squeeze_N.
Formula formula_of(const std::string& text, const std::string& name, const char* key,
                   const Place& place);

/// A formula that names what `quantities` knows; nullopt, with the problem in the diagnostics, if
/// its text gives no number of its kind.
std::optional<CompiledFormula> compile_formula(const Formula& formula, const TaskPlan& plan,
                                               Quantities& quantities, Diagnostics& diagnostics);

}  // namespace dihaptic::task
