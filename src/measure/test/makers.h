// The benches' plant with a maker's library (our fake of it) between servo and simulated device.
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

/// To 1 %; what is as good as nothing is that in both: `nothing` is a thousandth of what it takes
/// to be seen or felt.
inline void expect_alike(double a, double b, double nothing) {
    EXPECT_NEAR(a, b, std::max(0.01 * std::abs(a), nothing));
}

}  // namespace dihaptic::measure
