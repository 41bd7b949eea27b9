// Where the running program lies, and what came with it.
#pragma once

#include <string>

namespace dihaptic::app {

/// The folder that holds the shipped files (scenes, experiments and others): the current one, or
/// the project's, whose build made the program; "" if there is none.
std::string shipped_folder();

/// Whether a shell that is told `dihaptic` finds this program. `paths`: its PATH.
bool shell_finds_program(const std::string& paths);

/// The command after which it does.
std::string path_command();

}  // namespace dihaptic::app
