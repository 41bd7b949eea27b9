// Files that have to survive a loss of power are synchronised to the disk. Otherwise the operating
// system may keep their content in memory for half a minute or longer, and may write a new file's
// name later than its content.
#pragma once

#include <string>

namespace dihaptic {

/// Returns once the file is on the disk or, in the case of a folder, once the names in it are.
/// Throws Error if the disk fails. Does nothing on a file system that does not support
/// synchronisation.
void sync_to_disk(const std::string& name);
/// Like sync_to_disk(name), for a file that is already open and that messages call `name`.
void sync_to_disk(int descriptor, const std::string& name);

/// The remedy for a write that failed with the error number `error`, worded for use within a
/// sentence: "free some space".
std::string make_room(int error);

}  // namespace dihaptic
