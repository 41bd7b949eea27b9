// Whether ticks come in time here: what Linux is, and what it lets this user do.
#pragma once

#include "cli/doctor/finding.h"
#include "cli/doctor/machine.h"

namespace dihaptic::doctor {

Findings real_time(const std::string& root, const Rights& rights);

}  // namespace dihaptic::doctor
