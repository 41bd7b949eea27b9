// Inverse3 devices of one Inverse Service: one message carries the forces of all, and the answer
// their states. Whoever waits for the answer is paced by the service.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::haply {

/// Throws Error when the options do not fit together.
std::unique_ptr<DeviceGroup> make_group(const std::vector<DeviceConfig>& configs,
                                        const Context& context);

}  // namespace dihaptic::devices::haply
