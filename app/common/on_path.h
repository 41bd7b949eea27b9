// What a shell finds when it is told the name of a program, such as the running one's.
#pragma once

#include <string>

namespace dihaptic::app {

/// The file that runs as `program`; "" if there is none. `paths`: the shell's PATH.
std::string found_on(const std::string& paths, const std::string& program);

/// Whether a shell that is told `dihaptic` finds this program. `paths`: its PATH.
bool shell_finds_program(const std::string& paths);

/// The command after which it does.
std::string path_command();

}  // namespace dihaptic::app
