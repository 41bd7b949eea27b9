// The outcomes of a task's trials, as charts and the strip of trials show them.
#pragma once

#include "chart_painter.h"
#include "task/plan/task_plan.h"

namespace dihaptic::gui {

/// The names and colours of the outcomes: cold colours for those with which a trial is done, warm
/// ones for those after which it is repeated or the session ends, grey for a skipped trial.
std::vector<ChartPainter::Entry> outcomes_of(const task::TaskPlan& plan);

}  // namespace dihaptic::gui
