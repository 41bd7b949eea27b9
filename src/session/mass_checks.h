// Checks a scene's masses against the limits of the world's time step.
#pragma once

#include "session/plan.h"

namespace dihaptic::session {

/// Warns about bodies so heavy that they may push their support aside or pass through it, and about
/// links so light that a suspended load turns them faster than the time step can follow.
void check_masses(const Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::session
