// Checks of a plan that need its devices: force limits, passivity, and grips that are too weak.
#pragma once

#include "experiment/plan.h"

namespace dihaptic::experiment {

/// Resolves settings given as shares of what the devices render, checks the other settings against
/// the devices, and adds the warnings to the plan. Throws Error.
void check_with_devices(Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::experiment
