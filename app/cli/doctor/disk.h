// Checks whether the disk has room for sessions, and keeps up with them.
#pragma once

#include "cli/doctor/finding.h"

namespace dihaptic::doctor {

/// The remedy when recording to a folder is impossible.
constexpr const char* kAnotherDisk =
    "cd ~    # or any folder on another disk; or name one: dihaptic run FILE --out FOLDER";

/// The type of file system that holds `folder`, an absolute path; "" if unknown. `mounts`: the text
/// of /proc/self/mountinfo.
std::string file_system(const std::string& mounts, const std::string& folder);

/// Where this system is: installed on a disk, in a container, or live in memory after a start from
/// a USB stick.
enum class System { installed, container, live };
Finding kind_of_disk(const std::string& type, System system);

/// `speed`: measured speed of writing; `needed`: speed required by a session [bytes/s].
Finding keeps_up(double speed, double needed);

/// Checks the folder `sessions` or, while it does not exist, the current folder. Writes a file
/// there, and removes it again.
Findings disk();

}  // namespace dihaptic::doctor
