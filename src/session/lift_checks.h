// Checks of the objects that are lifted in a task's trials.
#pragma once

#include "session/plan.h"

namespace dihaptic::session {

/// Warns of lifts that the analysis would miss, and of objects that the devices cannot hold.
void check_lifts(const Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::session
