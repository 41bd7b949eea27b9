// Checks whether a task's sounds can be heard.
#pragma once

#include "cli/doctor/finding.h"
#include "cli/doctor/ports.h"

namespace dihaptic::doctor {

/// `failure`: reason why the sound device cannot be opened.
Finding silence(const std::string& root, const std::string& failure, const MayOpen& may_open);
/// Opens the system's sound device for a moment.
Finding sound(const std::string& root, const MayOpen& may_open);

}  // namespace dihaptic::doctor
