// The plant of the benchmarks, with a fake of a manufacturer's library between the servo and the
// simulated devices.
#pragma once

#include <gtest/gtest.h>

#include "devices/test/fakes.h"
#include "measure/grasp.h"

namespace dihaptic::measure {

inline BenchSetup by_maker(BenchSetup setup, const std::string& backend) {
    setup.make_devices = [backend](const std::vector<devices::DeviceConfig>& simulated,
                                   const devices::Context& context) {
        std::vector<devices::simulated::Options> options;
        options.reserve(simulated.size());
        for (const devices::DeviceConfig& config : simulated) {
            rig::Device device;
            device.options = config.options;
            options.push_back(simulated_options(device));
        }
        return devices::make_behind(backend, options, simulated, context);
    };
    return setup;
}

/// Expects that two values agree to a share of them, 1 % if omitted, or to within `nothing`, which
/// should be a thousandth of what can be seen or felt.
inline void expect_alike(double a, double b, double nothing, double share = 0.01) {
    EXPECT_NEAR(a, b, std::max(share * std::abs(a), nothing));
}

}  // namespace dihaptic::measure
