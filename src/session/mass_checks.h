// Checks a scene's masses against the limits of a step of the world.
#pragma once

#include "session/plan.h"

namespace dihaptic::session {

/// Warns of bodies so heavy that they may push their support aside or through, and of links so
/// light that a suspended load turns them faster than a step can follow.
void check_masses(const Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::session
