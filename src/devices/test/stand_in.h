// The tests' devices for a real backend: simulated devices behind a fake of its manufacturer's
// software. Each real backend's folder has its own in test/stand_in.h; fakes.h lists them.
#pragma once

#include <memory>

#include "devices/device_group.h"
#include "devices/simulated/options.h"

namespace dihaptic::devices {

struct StandIn {
    const char* backend;
    struct Made {
        std::vector<DeviceConfig> configs;  ///< configurations for the backend
        std::shared_ptr<void> service;      ///< must outlive the devices; null for a library
    };
    /// `simulated`: configurations of simulated devices. `context.driver` must outlive them.
    Made (*make)(std::vector<DeviceConfig> simulated, const Context& context);
};

/// The options of simulated devices. Throws Error.
inline std::vector<simulated::Options> options_of(const std::vector<DeviceConfig>& configs) {
    std::vector<simulated::Options> out(configs.size());
    Diagnostics diagnostics;
    for (size_t i = 0; i < configs.size(); ++i)
        read_given_fields(out[i], configs[i].options, diagnostics);
    diagnostics.throw_if_errors();
    return out;
}

}  // namespace dihaptic::devices
