// What the devices of one rig claim of the machine, seen without touching it: no two the same
// device, and all one library.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices {

/// `values` of option `key`, by device, "" where it is not given: reports those that are given
/// twice, and missing ones too where they are `needed`.
void check_distinct(const std::vector<DeviceConfig>& configs, const char* key,
                    const std::vector<std::string>& values, bool needed, Diagnostics& diagnostics);

/// `libraries`, by device: reports those that differ from the first.
void check_one_library(const std::vector<DeviceConfig>& configs,
                       const std::vector<std::string>& libraries, Diagnostics& diagnostics);

}  // namespace dihaptic::devices
