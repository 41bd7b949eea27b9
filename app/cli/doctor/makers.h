// Which devices of a maker are there, as `dihaptic devices` finds them through the maker's library.
#pragma once

#include "cli/doctor/finding.h"
#include "devices/device_group.h"

namespace dihaptic::doctor {

/// `backend`: its name.
Findings of_maker(const std::string& backend, const devices::Survey& survey);

}  // namespace dihaptic::doctor
