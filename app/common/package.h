// Runs commands of the Python package, which is installed beside the program, or built with it.
#pragma once

#include <string>

#include "base/child.h"

namespace dihaptic::app {

/// The folder in which Python finds the package dihaptic, here or installed; "" if there is none.
std::string python_folder();

/// How to start `main(arguments)` of a module of the package in `folder`, such as
/// dihaptic.reports.__main__; the arguments are to be added.
Launch python_launch(const std::string& folder, const std::string& module);

}  // namespace dihaptic::app
