// The targets that an experiment shows, for a picture of the experiment as a whole.
#pragma once

#include <vector>

#include "frame/task_frame.h"
#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// Returns each target that is shown by some state in some condition, once, and with its colour in
/// that state. Targets whose place depends on the trial are left out, as are those beyond
/// TaskFrame::kMostTargets.
std::vector<frame::TargetFrame> shown_targets(const TaskPlan& plan);

}  // namespace dihaptic::task
