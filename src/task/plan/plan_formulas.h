// Plans the quantities that the formulas of a task can use, and compiles the formulas.
#pragma once

#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// Defines the task's draws, factors and variables in plan.quantities, compiles the formulas in
/// plan.task, and stores in each formula the index of its compiled form.
void plan_formulas(TaskPlan& plan, Diagnostics& diagnostics);

/// Compiles the rules that apply after trials, and the conditions that end blocks. The plan's
/// outcomes must have been planned.
void plan_rules(TaskPlan& plan, Diagnostics& diagnostics);

/// Makes a formula from a text, for a number whose name ends in its unit, e.g. squeeze_N.
Formula formula_of(const std::string& text, const std::string& name, const char* key,
                   const Place& place);

/// Compiles a condition. Returns nullopt if the text is empty or has mistakes. Problems are added
/// to `diagnostics`.
std::optional<Expression> compile_condition(const std::string& text, Quantities& quantities,
                                            const Place& place, const char* key,
                                            Diagnostics& diagnostics);

/// Compiles a formula over `quantities`. If the text does not give a number of the required kind,
/// adds a problem to the diagnostics and returns nullopt.
std::optional<CompiledFormula> compile_formula(const Formula& formula, const TaskPlan& plan,
                                               Quantities& quantities, Diagnostics& diagnostics);

}  // namespace dihaptic::task
