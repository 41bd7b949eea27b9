// Runs commands of the Python package, which is installed with the program or built next to it.
#pragma once

#include <optional>
#include <string>

#include "base/child.h"

namespace dihaptic::app {

/// The folder in which Python finds the package `dihaptic`, built or installed; "" if there is
/// none.
std::string python_folder();

/// How to start `main(arguments)` in a module of the package in `folder`, such as
/// dihaptic.reports.__main__. The caller appends the arguments.
Launch python_launch(const std::string& folder, const std::string& module);

/// Waits until Python has ended, and returns its status as Child::wait() does. If the program is to
/// stop meanwhile, so is Python: by the terminal, which gives both the signal of Ctrl-C, or else,
/// after a second, by the same signal from here; and if it has not ended after half a minute, it is
/// killed.
std::optional<int> wait_for_python(Child& python);

}  // namespace dihaptic::app
