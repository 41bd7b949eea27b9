// Checks whether this user may open the USB devices and serial ports that are plugged in.
#pragma once

#include <functional>

#include "cli/doctor/finding.h"

namespace dihaptic::doctor {

/// Whether the user may read and write a file.
using MayOpen = std::function<bool(const std::string& file)>;

Findings ports(const std::string& root, const MayOpen& may_open);

}  // namespace dihaptic::doctor
