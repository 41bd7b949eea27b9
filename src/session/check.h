// The command `dihaptic check`: checks any of Dihaptic's files before a person sits down.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic::session {

struct Checked {
    std::string what;                 ///< kind of the file, as text
    std::vector<std::string> limits;  ///< force limits that differ from the defaults, with their
                                      ///< origins: describe_safety()
};

/// Reads any file of a kind that Dihaptic knows, and the files that it names; problems are reported
/// to `diagnostics`. `rig`: a rig file to use in place of the experiment's; may be empty.
Checked check_file(const std::string& file, Diagnostics& diagnostics, const std::string& rig = "");

}  // namespace dihaptic::session
