// The libraries that a user allows this program to load. Files that come
// from other people may name libraries too, and loading a library runs its code.
//
// The list is a YAML file that belongs to the user, $XDG_CONFIG_HOME/dihaptic/libraries.yaml or
// ~/.config/dihaptic/libraries.yaml:
//
//   - /opt/OpenHaptics/lib/libHD.so
#pragma once

#include <string>

namespace dihaptic {

/// Path of the list; "" if the user has no home.
std::string allowed_libraries_file();

/// Whether the loader itself looks for a library with this name in the system's folders, which it
/// does if the name has no folder.
bool is_system_library(const std::string& name);

/// Whether the list contains this file. Throws Error when the list cannot be read.
bool is_allowed_library(const std::string& path);

}  // namespace dihaptic
