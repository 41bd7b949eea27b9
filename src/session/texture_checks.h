// Checks textures against the limits of contacts and against the speed at which hands move.
#pragma once

#include "session/plan.h"

namespace dihaptic::session {

/// Warns about textures that the loop cannot render, that a proxy does not feel, or whose height is
/// limited in a trial.
void check_textures(const Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::session
