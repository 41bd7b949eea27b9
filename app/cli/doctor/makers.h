// Finds the devices of a maker through the maker's library, as `dihaptic devices` does.
#pragma once

#include "cli/doctor/finding.h"
#include "devices/device_group.h"

namespace dihaptic::doctor {

/// `backend`: name of the maker's backend.
Findings of_maker(const std::string& backend, const devices::Survey& survey);

}  // namespace dihaptic::doctor
