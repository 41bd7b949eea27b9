// dihaptic check: any file, before a person sits down.
#pragma once

#include <string>

#include "base/diagnostics.h"

namespace dihaptic::experiment {

/// Reads any file that Dihaptic knows, with the files that it names; problems go to `diagnostics`.
/// `rig`: a rig file, in place of an experiment's; or empty. Returns what the file is, in words.
std::string check_file(const std::string& file, Diagnostics& diagnostics,
                       const std::string& rig = "");

}  // namespace dihaptic::experiment
