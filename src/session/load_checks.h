// Checks of a task's loads against what the loop, the devices and the world's step can hold.
#pragma once

#include "session/plan.h"

namespace dihaptic::session {

/// Warns of loads that shake or throw a handle, drive a hand on, are cut off at a device's or the
/// safety's limit, or make a body diverge. A torque on a handle that renders none is an error.
void check_loads(const Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::session
