// Inverse3 devices of one Inverse Service: one message carries the forces of all, and the answer
// their states. Whoever waits for the answer is paced by the service.
#pragma once

#include "devices/device_group.h"
#include "devices/haply/options.h"

namespace dihaptic::devices::haply {

/// The devices' options, read and checked.
Options read_options(const DeviceConfig& config, Diagnostics& diagnostics);

/// Throws Error.
std::unique_ptr<DeviceGroup> make_group(const std::vector<DeviceConfig>& configs,
                                        const Context& context);

/// What the service at a url lists.
Survey survey_of(const std::string& url);

}  // namespace dihaptic::devices::haply
