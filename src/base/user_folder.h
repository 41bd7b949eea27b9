// The user's own folders, for data that belongs to no project (XDG Base Directory
// Specification 0.8).
#pragma once

#include <string>

namespace dihaptic {

/// Folder for settings, usually ~/.config; "" if the user has no home directory.
std::string user_config();
/// Folder for files that are used in all studies, usually ~/.local/share; "" if the user has no
/// home directory.
std::string user_data();
/// Folder for files that can be regenerated, usually ~/.cache; "" if the user has no home
/// directory.
std::string user_cache();

}  // namespace dihaptic
