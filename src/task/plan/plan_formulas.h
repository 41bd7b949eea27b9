// Plans the quantities available to the formulas of a task, and compiles the formulas.
#pragma once

#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// Defines the task's draws, factors and variables in plan.quantities, compiles the formulas of
/// plan.task, and stores in each the index
/// of its compiled form.
void plan_formulas(TaskPlan& plan, Diagnostics& diagnostics);

/// Compiles the rules after trials and the conditions that end blocks. The plan's outcomes must be
/// ready.
void plan_rules(TaskPlan& plan, Diagnostics& diagnostics);

/// Makes a formula from a text, for a number whose name has its unit, e.g. squeeze_N.
Formula formula_of(const std::string& text, const std::string& name, const char* key,
                   const Place& place);

/// Compiles a condition; nullopt if the text is empty or has mistakes. Problems go to
/// `diagnostics`.
std::optional<Expression> compile_condition(const std::string& text, Quantities& quantities,
                                            const Place& place, const char* key,
                                            Diagnostics& diagnostics);

/// Compiles a formula over `quantities`; nullopt, with a problem in the diagnostics, if its text
/// does not give a number of the required kind.
std::optional<CompiledFormula> compile_formula(const Formula& formula, const TaskPlan& plan,
                                               Quantities& quantities, Diagnostics& diagnostics);

}  // namespace dihaptic::task
