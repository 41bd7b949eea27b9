// Checks textures against the limits of a contact, and against how fast hands move.
#pragma once

#include "session/plan.h"

namespace dihaptic::session {

/// Warns of textures that the loop cannot render, that a proxy does not feel, or whose height a
/// trial limits.
void check_textures(const Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::session
