// Checks whether Dihaptic is complete: the programs next to this one, the programs of other
// projects that it calls, and the shipped files.
#pragma once

#include <functional>
#include <string>

#include "cli/doctor/finding.h"

namespace dihaptic::doctor {

/// `companion`: returns the path of one of Dihaptic's programs, or "" if it is missing. `paths`:
/// value of PATH. `shipped`: the folder with the shipped files; "" if it is missing. `python`: the
/// folder of the Python package; "" if it is missing.
Findings parts(const std::function<std::string(const std::string&)>& companion,
               const std::string& paths, const std::string& shipped, const std::string& python);

}  // namespace dihaptic::doctor
