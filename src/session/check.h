// The command `dihaptic check`, which checks any of Dihaptic's files before a person sits down.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic::session {

struct Checked {
    std::string what;                 ///< kind of file, as text
    std::vector<std::string> limits;  ///< force limits that differ from the defaults, with their
                                      ///< origins: describe_safety()
};

/// Reads a file of any kind that Dihaptic knows, and all files that it refers to; reports problems
/// to `diagnostics`. `rig` is a rig file to use instead of the experiment's; it may be empty.
Checked check_file(const std::string& file, Diagnostics& diagnostics, const std::string& rig = "");

}  // namespace dihaptic::session
