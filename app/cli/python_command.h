// Commands whose work the Python package does.
#pragma once

#include <string>
#include <vector>

namespace dihaptic::cli {

/// Runs the module of the package, such as dihaptic.power_analysis.__main__, with these arguments,
/// and takes over its exit status. Throws Error about `file`, which "has no RESULT yet", if the
/// package is missing or Python cannot be started.
void run_python(const std::string& file, const std::string& result, const std::string& module,
                const std::vector<std::string>& arguments);

}  // namespace dihaptic::cli
