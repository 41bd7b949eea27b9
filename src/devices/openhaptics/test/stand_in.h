// Simulated devices behind the fake libHD.
#pragma once

#include <fmt/format.h>

#include "devices/openhaptics/test/fake_hd.h"
#include "devices/test/plant_hand.h"
#include "devices/test/stand_in.h"

namespace dihaptic::devices::openhaptics {

inline StandIn stand_in() {
    return {"openhaptics", [](std::vector<DeviceConfig> configs, const Context& context) {
                const std::vector<simulated::Options> options = options_of(configs);
                FakeHd& fake = fake_hd();
                fake.hand = plant_hand(configs, context);
                constexpr double kLarge = 1e6;  // so large that it is practically no limit
                for (size_t i = 0; i < configs.size(); ++i) {
                    FakeHd::Device& device = fake.devices[i];
                    device.max_force = options[i].peak_force;
                    device.continuous_force = options[i].continuous_force.value_or(kLarge);
                    device.input_dof = options[i].orientation ? 6 : 3;
                    device.output_dof = options[i].peak_torque > 0 ? 6 : 3;
                    if (options[i].peak_torque > 0)
                        device.max_torque = options[i].peak_torque * 1e3;
                    const Vec3 edges = options[i].workspace.value_or(Vec3::Constant(2)) * 1e3;
                    for (int axis = 0; axis < 3; ++axis) {
                        // not centred on the origin, like manufacturers' workspaces
                        device.workspace[axis] = -0.4 * edges[axis];
                        device.workspace[axis + 3] = 0.6 * edges[axis];
                    }
                    configs[i].options =
                        parse_yaml(fmt::format("library: {}\nname: {}\nserial: {}\n",
                                               DIHAPTIC_FAKE_HD, device.name, device.serial),
                                   "rig.yaml");
                }
                return StandIn::Made{std::move(configs), nullptr};
            }};
}

}  // namespace dihaptic::devices::openhaptics
