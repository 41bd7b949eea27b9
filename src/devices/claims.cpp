#include "devices/claims.h"

#include <fmt/format.h>

namespace dihaptic::devices {

void check_distinct(const std::vector<DeviceConfig>& configs, const char* key,
                    const std::vector<std::string>& values, bool needed, Diagnostics& diagnostics) {
    for (size_t i = 0; i < values.size(); ++i) {
        if (values[i].empty()) {
            if (needed) {
                diagnostics.error(configs[i].place, key, "is needed if there are several devices",
                                  "Give it in options; dihaptic devices lists the devices found.");
            }
            continue;
        }
        for (size_t j = 0; j < i; ++j) {
            if (values[i] != values[j]) continue;
            diagnostics.error(
                configs[i].place, key,
                fmt::format("'{}' is also given for the {}'s device", values[i], configs[j].finger),
                "Give each device its own value.");
        }
    }
}

void check_one_library(const std::vector<DeviceConfig>& configs,
                       const std::vector<std::string>& libraries, Diagnostics& diagnostics) {
    for (size_t i = 0; i < libraries.size(); ++i) {
        if (libraries[i] == libraries.front()) continue;
        diagnostics.error(configs[i].place, "library", "differs from the first device's",
                          "Give the same library for all devices of a rig.");
    }
}

}  // namespace dihaptic::devices
