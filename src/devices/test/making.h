// What the tests of makers' backends share: devices from rig files' options, and what is said when
// they cannot be.
#pragma once

#include <gtest/gtest.h>

#include "devices/device_group.h"

namespace dihaptic::devices {

/// Devices of the thumb and so on, by lines of YAML each.
inline std::unique_ptr<DeviceGroup> make_devices(const Backend& backend,
                                                 const std::vector<std::string>& options,
                                                 const std::string& library, double tick = 1e-3) {
    std::vector<DeviceConfig> configs;
    const char* const fingers[] = {"thumb", "index", "middle"};
    for (size_t i = 0; i < options.size(); ++i) {
        configs.push_back({fingers[i],
                           {},
                           parse_yaml(options[i] + "library: " + library + "\n", "rig.yaml"),
                           {"rig.yaml", static_cast<int>(i + 1)}});
    }
    Context context;
    context.tick = tick;
    return backend.make(configs, context);
}

/// What is said when it fails.
template <class Call>
std::string told(const Call& call) {
    try {
        call();
    } catch (const Error& e) {
        return e.what();
    }
    return "nothing";
}
inline void expect_in(const std::string& part, const std::string& text) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

}  // namespace dihaptic::devices
