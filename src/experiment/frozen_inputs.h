// A session keeps copies of all that it was made from: what was run is what can be run again, and
// told from what its files say today.
#pragma once

#include <vector>

#include "experiment/plan.h"
#include "recording/session.h"

namespace dihaptic::experiment {

/// Writes the plan's scene, with its meshes, rig, settings, movement, task and person to the
/// session's folder. Returns what was written.
std::vector<recording::InputFile> freeze_inputs(const Plan& plan,
                                                const recording::SessionFolder& folder);

}  // namespace dihaptic::experiment
