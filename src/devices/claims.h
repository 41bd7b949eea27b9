// Checks a rig's devices without touching the hardware: no two entries may refer to the same
// device, and all must use the same library.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices {

/// Reports values of the option `key` that are given twice and, if the option is `needed`, missing
/// values. `values` has one value per device, "" if it was not given.
void check_distinct(const std::vector<DeviceConfig>& configs, const char* key,
                    const std::vector<std::string>& values, bool needed, Diagnostics& diagnostics);

/// Reports libraries that differ from the first. `libraries` has one library per device.
void check_one_library(const std::vector<DeviceConfig>& configs,
                       const std::vector<std::string>& libraries, Diagnostics& diagnostics);

}  // namespace dihaptic::devices
