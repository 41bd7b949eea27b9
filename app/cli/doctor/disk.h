// Whether the disk has room for sessions, and keeps up with them.
#pragma once

#include "cli/doctor/finding.h"

namespace dihaptic::doctor {

/// What to do when a folder cannot be recorded to.
constexpr const char* kAnotherDisk =
    "cd ~    # or any folder on another disk; or name one: dihaptic run FILE --out FOLDER";

/// The type of file system that holds `folder`, an absolute path; "" if it is not known.
/// `mounts`: the text of /proc/self/mountinfo.
std::string file_system(const std::string& mounts, const std::string& folder);

/// Where this system stands: on a disk, in a container, or in memory, started from a USB stick.
enum class System { installed, container, live };
Finding kind_of_disk(const std::string& type, System system);

/// `speed`: of writing; `needed`: by a session [bytes/s].
Finding keeps_up(double speed, double needed);

/// Looks at the folder for sessions: `sessions`, or where that would be made. Writes a file there,
/// which is gone afterwards.
Findings disk();

}  // namespace dihaptic::doctor
