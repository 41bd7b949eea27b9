// dihaptic check: any file, before a person sits down.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic::experiment {

struct Checked {
    std::string what;                 ///< the file is, in words
    std::vector<std::string> limits;  ///< on force that somebody set, and who: describe_safety()
};

/// Reads any file that Dihaptic knows, with the files that it names; problems go to `diagnostics`.
/// `rig`: a rig file, in place of an experiment's; or empty.
Checked check_file(const std::string& file, Diagnostics& diagnostics, const std::string& rig = "");

}  // namespace dihaptic::experiment
