// Plans a task's states: what each asks and begins, and the ways out of it.
#pragma once

#include "task/plan/body_planner.h"
#include "task/plan/seen_plan.h"

namespace dihaptic::task {

/// Plans all states, and with them the outcomes of trials. The plan must have its formulas.
void plan_states(const Planning& given, BodyPlanner& bodies, SeenPlanner& seen);

/// The fingers that are named.
scene::FingerSet fingers_of(const RefList<scene::Finger>& names);

}  // namespace dihaptic::task
