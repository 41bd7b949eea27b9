// The libraries that a user allows this program to load. Files from other people may also name
// libraries, and loading a library runs its code.
//
// The list is a YAML file that belongs to the user, $XDG_CONFIG_HOME/dihaptic/libraries.yaml or
// ~/.config/dihaptic/libraries.yaml:
//
//   - /opt/OpenHaptics/lib/libHD.so
#pragma once

#include <string>

namespace dihaptic {

/// Path of the file that contains the list; "" if the user has no home directory.
std::string allowed_libraries_file();

/// Whether the loader searches the system's folders for a library with this name, which it does if
/// the name contains no folder.
bool is_system_library(const std::string& name);

/// Whether the list contains this file. Throws Error if the list cannot be read.
bool is_allowed_library(const std::string& path);

}  // namespace dihaptic
