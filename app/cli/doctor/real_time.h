// Checks whether ticks can be on time on this machine: the Linux kernel, and this user's rights.
#pragma once

#include "cli/doctor/finding.h"
#include "cli/doctor/machine.h"

namespace dihaptic::doctor {

Findings real_time(const std::string& root, const Rights& rights);

}  // namespace dihaptic::doctor
