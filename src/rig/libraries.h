// Libraries that a rig names. Nobody can foresee what they do when they are loaded, so they are
// loaded only if the operator named the rig, or allows the library (base/allowed_libraries.h). A
// rig that an experiment names, or that lies in a session, may be a stranger's. docs/adr/0023.
#pragma once

#include "rig/rig.h"

namespace dihaptic::rig {

/// Makes paths of libraries absolute: a path in a file is relative to the file's folder, wherever
/// the program was started.
void find_libraries(Rig& rig, const std::string& rig_file);

/// A problem for each library that the rig names by a path and that is not in the user's list, with
/// the message that would be given when it is loaded.
std::vector<Problem> strange_libraries(const Rig& rig);

/// Throws Error when a rig that the operator did not name would load libraries. Call before its
/// devices, outlets or trackers are opened.
void check_libraries(const Rig& rig);

}  // namespace dihaptic::rig
