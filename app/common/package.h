// Runs commands of the Python package, which is installed with the program or built next to it.
#pragma once

#include <string>

#include "base/child.h"

namespace dihaptic::app {

/// The folder in which Python finds the package `dihaptic`, built or installed; "" if there is
/// none.
std::string python_folder();

/// How to start `main(arguments)` in a module of the package in `folder`, such as
/// dihaptic.reports.__main__. The caller appends the arguments.
Launch python_launch(const std::string& folder, const std::string& module);

}  // namespace dihaptic::app
