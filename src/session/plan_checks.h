// Checks of a plan against its devices: force limits, passivity, and grips that are too weak.
#pragma once

#include "session/plan.h"

namespace dihaptic::session {

/// The names of factors, draws, variables and measures are columns of trials.csv, in addition to
/// its standard columns.
void check_columns(const Plan& plan, Diagnostics& diagnostics);

/// Resolves settings given as shares of the maximum of plan.devices, and checks the other settings
/// against them. Devices that report it only once they are open are skipped. Throws Error.
void check_devices(Plan& plan, Diagnostics& diagnostics);
/// Like check_devices, with the checks that do not require devices. Throws Error.
void check_plan(Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::session
