// Refuses names of outputs that would replace somebody's recordings, tables or inputs.
#pragma once

#include <string>

namespace dihaptic::app {

/// Checks the name of a file that a command is about to write. An existing file is replaced only if
/// its name ends as this kind of file does, and not if it lies in a session's folder, unless it is
/// a picture or a video that does not belong to the session. `ending`: such as ".png". `input` is
/// the file or folder that is read, and `what` its description. Throws Error, also when the file
/// cannot be written.
void check_output_file(const std::string& file, const std::string& input, const std::string& what,
                       const std::string& ending);

}  // namespace dihaptic::app
