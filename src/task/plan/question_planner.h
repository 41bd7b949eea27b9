// Plans the questions that a state asks, and checks the exits that wait for their answers.
#pragma once

#include "task/plan/seen_plan.h"

namespace dihaptic::task {

/// Plans the questions of a state. The levels of the plan must already be known.
TaskPlan::Questions plan_questions(const Planning& given, SeenPlanner& seen, const State& state);

}  // namespace dihaptic::task
