// Checks of a plan that need its devices: force limits, passivity, and grips that are too weak.
#pragma once

#include "session/plan.h"

namespace dihaptic::session {

/// Resolves settings given as shares of what plan.devices render, and checks the other settings
/// against them. Devices that only say so once they are open are passed over. Throws Error.
void check_devices(Plan& plan, Diagnostics& diagnostics);
/// The same, with the checks that need no devices. Throws Error.
void check_plan(Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::session
