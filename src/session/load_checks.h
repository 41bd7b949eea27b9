// Checks a task's loads against the limits of the loop, the devices and the world's time step.
#pragma once

#include "session/plan.h"

namespace dihaptic::session {

/// Warns about loads that shake or throw a handle, keep driving a hand, exceed a device's limit or
/// the safety limit, or make a body diverge. A torque on a handle that cannot render torques is an
/// error.
void check_loads(const Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::session
