// Finds the program that a shell runs under a name, such as that of the running program.
#pragma once

#include <string>

namespace dihaptic::app {

/// The file that runs as `program`; "" if there is none. `paths`: the shell's PATH.
std::string found_on(const std::string& paths, const std::string& program);

/// Whether a shell finds this program under the name `dihaptic`. `paths`: its PATH.
bool shell_finds_program(const std::string& paths);

/// The command after which a shell finds this program.
std::string path_command();

}  // namespace dihaptic::app
