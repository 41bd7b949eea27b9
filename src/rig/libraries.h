// Libraries named in a rig. Loading them may have any effect, so they are
// loaded only if the operator named the rig, or allows the library (base/allowed_libraries.h). A
// rig that an experiment names, or that is in a session's folder, may be a stranger's
// (docs/adr/0023).
#pragma once

#include "rig/rig.h"

namespace dihaptic::rig {

/// Makes paths of libraries absolute: a path in a file is relative to the file's folder,
/// independent of the program's working folder.
void find_libraries(Rig& rig, const std::string& rig_file);

/// A problem for each library that the rig names by a path and that the user's list lacks, with
/// the message of an attempt to load it.
std::vector<Problem> strange_libraries(const Rig& rig);

/// Throws Error when a rig that the operator did not name would load libraries. To be called before
/// its devices, outlets or trackers are opened.
void check_libraries(const Rig& rig);

}  // namespace dihaptic::rig
