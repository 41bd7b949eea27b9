// What has to outlive a loss of power is synchronised: the system keeps what was written in memory
// for half a minute and more, and the name of a new file apart from its content.
#pragma once

#include <string>

namespace dihaptic {

/// Returns once the file, or, of a folder, the names in it, are on the disk. Throws Error when the
/// disk fails; a file system that cannot do it is let be.
void sync_to_disk(const std::string& name);
/// The same of an open file, called `name` in messages.
void sync_to_disk(int descriptor, const std::string& name);

}  // namespace dihaptic
