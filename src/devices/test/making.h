// Functions shared by the tests of manufacturers' backends, which make devices from options like
// those in rig files, and catch the message of a failure.
#pragma once

#include <gtest/gtest.h>

#include "devices/device_group.h"

namespace dihaptic::devices {

/// Makes the devices of the thumb, index and middle finger. `options` contains the YAML text for
/// each device.
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

/// Returns the message of the Error that `call` throws.
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
