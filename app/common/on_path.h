// How a shell finds the running program.
#pragma once

#include <string>

namespace dihaptic::app {

/// Whether a shell that is told `dihaptic` finds this program. `paths`: its PATH.
bool shell_finds_program(const std::string& paths);

/// The command after which it does.
std::string path_command();

}  // namespace dihaptic::app
