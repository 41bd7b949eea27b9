// Plans a task's states: their displays, questions, sounds and exits.
#pragma once

#include "task/plan/body_planner.h"
#include "task/plan/seen_plan.h"

namespace dihaptic::task {

/// Plans all states and the outcomes of trials. The plan's formulas must already be compiled.
void plan_states(const Planning& given, BodyPlanner& bodies, SeenPlanner& seen);

/// Returns the set of the named fingers.
scene::FingerSet fingers_of(const RefList<scene::Finger>& names);

}  // namespace dihaptic::task
