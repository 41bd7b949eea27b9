// Copies everything that a session was made from into its folder, so that the session can be run
// again as it was, and so that later changes to the original files can be told.
#pragma once

#include <vector>

#include "recording/session.h"
#include "session/plan.h"

namespace dihaptic::session {

/// Writes the plan's scene with its meshes and pictures, its rig, settings, movement, task and
/// person to the session's folder. Returns the files written. Throws Error when one of them cannot
/// be, or when a file that the plan was made from was changed since it was read.
std::vector<recording::InputFile> freeze_inputs(const Plan& plan,
                                                const recording::SessionFolder& folder);

}  // namespace dihaptic::session
