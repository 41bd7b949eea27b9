// Checks a plan against its devices: force limits, passivity, and grips that are too weak.
#pragma once

#include "session/plan.h"

namespace dihaptic::session {

/// Checks the names of a task's factors, draws, variables and measures, which become columns of
/// trials.csv, in addition to the standard columns.
void check_columns(const Plan& plan, Diagnostics& diagnostics);

/// Resolves settings given as a share of the maximum of plan.devices, and checks the other settings
/// against that maximum. Devices that report their maximum only once they are open are skipped.
/// Throws Error.
void check_devices(Plan& plan, Diagnostics& diagnostics);
/// Like check_devices(), but makes only the checks that do not require devices. Throws Error.
void check_plan(Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::session
