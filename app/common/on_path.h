// Finds the program that a shell would run under a given name, such as the name of the running
// program.
#pragma once

#include <string>

namespace dihaptic::app {

/// The file that a shell would run as `program`; "" if there is none. `paths`: the shell's PATH.
std::string found_on(const std::string& paths, const std::string& program);

/// Whether a shell finds this program under the name `dihaptic`. `paths`: the shell's PATH.
bool shell_finds_program(const std::string& paths);

/// The command to type so that a shell finds this program from then on.
std::string path_command();

}  // namespace dihaptic::app
