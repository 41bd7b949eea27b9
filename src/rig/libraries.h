// Libraries named in a rig. Loading a library can have any effect, so it is loaded only if the
// operator named the rig or has allowed the library (base/allowed_libraries.h). A rig that is named
// by an experiment, or found in a session's folder, may come from a stranger (docs/adr/0023).
#pragma once

#include "rig/rig.h"

namespace dihaptic::rig {

/// Makes the paths of libraries absolute. A path in a file is relative to the file's folder, not to
/// the program's working folder.
void find_libraries(Rig& rig, const std::string& rig_file);

/// Returns a problem for each library that the rig names by a path and that the user's list does
/// not contain. The problem's message is that of an attempt to load the library.
std::vector<Problem> strange_libraries(const Rig& rig);

/// Throws Error if the rig was not named by the operator and would load libraries that are not
/// allowed. Must be called before the rig's devices, outlets or trackers are opened.
void check_libraries(const Rig& rig);

}  // namespace dihaptic::rig
