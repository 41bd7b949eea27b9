// A group of the Inverse3 devices of one Inverse Service: one message carries the forces of all
// devices, and its answer their states. The service paces the tick by its answers.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::haply {

/// The information in the devices' options; the service adds none.
std::vector<frame::DeviceInfo> describe_group(const std::vector<DeviceConfig>& configs,
                                              const Context& context, Diagnostics& diagnostics);
/// Makes the group. Throws Error if the devices' options are incompatible.
std::unique_ptr<DeviceGroup> make_group(const std::vector<DeviceConfig>& configs,
                                        const Context& context);

}  // namespace dihaptic::devices::haply
