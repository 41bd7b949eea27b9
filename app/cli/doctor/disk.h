// Checks whether the disk has room for sessions, and whether it is fast enough for them.
#pragma once

#include "cli/doctor/finding.h"

namespace dihaptic::doctor {

/// The remedy when a folder cannot be recorded to.
constexpr const char* kAnotherDisk =
    "cd ~    # or any folder on another disk; or name one: dihaptic run FILE --out FOLDER";

/// The type of the file system that holds `folder`, an absolute path; "" if the type is unknown.
/// `mounts`: the text of /proc/self/mountinfo.
std::string file_system(const std::string& mounts, const std::string& folder);

/// Where this system runs: installed on a disk, in a container, or live in memory, started from a
/// USB stick.
enum class System { installed, container, live };
Finding kind_of_disk(const std::string& type, System system);

/// `speed`: measured writing speed; `needed`: speed required by a session [bytes/s].
Finding keeps_up(double speed, double needed);

/// Checks the folder `sessions` or, if it does not exist yet, the current folder. Writes a test
/// file there, and removes it again.
Findings disk();

}  // namespace dihaptic::doctor
