// Simulated devices behind the fake libdhd.
#pragma once

#include <fmt/format.h>

#include "devices/forcedimension/test/fake_dhd.h"
#include "devices/test/plant_hand.h"
#include "devices/test/stand_in.h"

namespace dihaptic::devices::forcedimension {

inline StandIn stand_in() {
    return {"forcedimension", [](std::vector<DeviceConfig> configs, const Context& context) {
                const std::vector<simulated::Options> options = options_of(configs);
                FakeDhd& fake = fake_dhd();
                fake.hand = plant_hand(configs, context);
                fake.period = context.tick;
                for (size_t i = 0; i < configs.size(); ++i) {
                    FakeDhd::Device& device = fake.devices[i];
                    device.max_force = options[i].peak_force;
                    device.wrist = options[i].orientation;
                    device.active_wrist = options[i].peak_torque > 0;
                    device.max_torque = device.active_wrist ? options[i].peak_torque : -1;
                    configs[i].options = parse_yaml(
                        fmt::format("library: {}\nserial: {}\n", DIHAPTIC_FAKE_DHD, device.serial),
                        "rig.yaml");
                }
                return StandIn::Made{std::move(configs), nullptr};
            }};
}

}  // namespace dihaptic::devices::forcedimension
