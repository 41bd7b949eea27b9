// Checks of a scene's masses against what a step of the world can hold.
#pragma once

#include "session/plan.h"

namespace dihaptic::session {

/// Warns of bodies so heavy that what they rest on may be pushed aside or through, and of links so
/// light that what hangs on them turns them faster than a step can follow.
void check_masses(const Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::session
