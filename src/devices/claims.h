// Checks of a rig's devices without touching the machine: no two entries are the same device, and
// all use the same library.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices {

/// `values`: of option `key`, by device; "" if not given. Reports values that are given
/// twice, and missing ones if the option is `needed`.
void check_distinct(const std::vector<DeviceConfig>& configs, const char* key,
                    const std::vector<std::string>& values, bool needed, Diagnostics& diagnostics);

/// `libraries`: by device. Reports libraries that differ from the first.
void check_one_library(const std::vector<DeviceConfig>& configs,
                       const std::vector<std::string>& libraries, Diagnostics& diagnostics);

}  // namespace dihaptic::devices
