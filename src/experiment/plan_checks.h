// What can be told of a plan only with its devices in view: limits, passivity, grips that fall
// short.
#pragma once

#include "experiment/plan.h"

namespace dihaptic::experiment {

/// Resolves shares of what the devices render, checks the rest against them, and puts what is worth
/// a warning into the plan. Throws Error.
void check_with_devices(Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::experiment
