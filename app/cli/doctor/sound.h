// Checks whether the sounds of a task can be heard.
#pragma once

#include "cli/doctor/finding.h"
#include "cli/doctor/ports.h"

namespace dihaptic::doctor {

/// The finding when there is no sound. `failure`: reason why the sound device cannot be opened.
Finding silence(const std::string& root, const std::string& failure, const MayOpen& may_open);
/// Checks whether the system's sound device can be opened.
Finding sound(const std::string& root, const MayOpen& may_open);

}  // namespace dihaptic::doctor
