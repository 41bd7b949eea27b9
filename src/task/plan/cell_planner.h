// Plans what differs between trials: regions, perturbations, placements of bodies, and looks.
#pragma once

#include "task/plan/body_planner.h"
#include "task/plan/seen_plan.h"

namespace dihaptic::task {

/// Plans a cell for each condition in each round. The plan's formulas must already be compiled.
void plan_cells(const Planning& given, const BodyPlanner& bodies, const SeenPlanner& seen);

}  // namespace dihaptic::task
