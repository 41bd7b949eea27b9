// Copies all inputs of a session into its folder, so that the session can be repeated with the same
// inputs, and so that later changes to the original files can be detected.
#pragma once

#include <vector>

#include "recording/session.h"
#include "session/plan.h"

namespace dihaptic::session {

/// Writes the plan's scene (with meshes and pictures), rig, settings, movement, task and person to
/// the session's folder. Returns the files written. Throws Error if a file cannot be written, or if
/// an input of the plan has changed since it was read.
std::vector<recording::InputFile> freeze_inputs(const Plan& plan,
                                                const recording::SessionFolder& folder);

}  // namespace dihaptic::session
