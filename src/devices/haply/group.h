// A group of the Inverse3 devices of one Inverse Service. One message contains the forces for all
// devices, and the answer to it contains their states. The service's answers pace the tick.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::haply {

/// The device information that follows from the options; the service does not add to it.
std::vector<frame::DeviceInfo> describe_group(const std::vector<DeviceConfig>& configs,
                                              const Context& context, Diagnostics& diagnostics);
/// Makes the group. Throws Error if the options of the devices are incompatible.
std::unique_ptr<DeviceGroup> make_group(const std::vector<DeviceConfig>& configs,
                                        const Context& context);

}  // namespace dihaptic::devices::haply
