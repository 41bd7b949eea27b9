// Libraries that a rig names: what they do when they are loaded nobody can foresee, so code is
// loaded only if the operator named the rig, or allows the library (base/allowed_libraries.h). A
// rig that an experiment names, or that lies in a session, may be a stranger's. docs/adr/0023.
#pragma once

#include "rig/rig.h"

namespace dihaptic::rig {

/// Makes paths of libraries whole: one in a file is from the file's own folder, wherever the
/// program was started.
void find_libraries(Rig& rig, const std::string& rig_file);

/// The libraries that the rig names by a path and that its reader's own list does not have: a
/// problem for each, as it is told when one would be loaded.
std::vector<Problem> strange_libraries(const Rig& rig);

/// Throws Error when a rig that the operator did not name would have libraries loaded. Call before
/// its devices, outlets or trackers are opened.
void check_libraries(const Rig& rig);

}  // namespace dihaptic::rig
