// Devices with which a real backend is tested: simulated devices behind a fake of the
// manufacturer's software. The folder of each real backend defines them in test/stand_in.h; fakes.h
// lists them all.
#pragma once

#include <memory>

#include "devices/device_group.h"
#include "devices/simulated/options.h"

namespace dihaptic::devices {

struct StandIn {
    const char* backend;
    struct Made {
        std::vector<DeviceConfig> configs;  ///< configurations of the devices, for the backend
        std::shared_ptr<void> service;      ///< the fake service; must outlive the devices
    };
    /// `simulated` are the configurations of simulated devices. `context.driver` must outlive the
    /// devices.
    Made (*make)(std::vector<DeviceConfig> simulated, const Context& context);
};

/// The options of simulated devices. Throws Error if they are invalid.
inline std::vector<simulated::Options> options_of(const std::vector<DeviceConfig>& configs) {
    std::vector<simulated::Options> out(configs.size());
    Diagnostics diagnostics;
    for (size_t i = 0; i < configs.size(); ++i)
        read_given_fields(out[i], configs[i].options, diagnostics);
    diagnostics.throw_if_errors();
    return out;
}

}  // namespace dihaptic::devices
