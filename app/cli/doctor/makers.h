// Finds a maker's devices through the maker's library, like `dihaptic devices`.
#pragma once

#include "cli/doctor/finding.h"
#include "devices/device_group.h"

namespace dihaptic::doctor {

/// `backend`: name of the backend.
Findings of_maker(const std::string& backend, const devices::Survey& survey);

}  // namespace dihaptic::doctor
