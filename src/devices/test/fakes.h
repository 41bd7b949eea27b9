// Makes rigs of simulated devices that are run through the makers' fake libraries.
#pragma once

#include <fmt/format.h>

#include "devices/forcedimension/test/fake_dhd.h"
#include "devices/openhaptics/test/fake_hd.h"
#include "devices/test/plant_hand.h"

namespace dihaptic::devices {

/// Makes fake devices whose handles move as simulated ones, and the real backend's group on them.
/// `context.driver` has to outlive the group.
inline std::unique_ptr<DeviceGroup> make_behind(const std::string& backend,
                                                const std::vector<simulated::Options>& options,
                                                std::vector<DeviceConfig> configs,
                                                const Context& context) {
    std::vector<Pose> X_WD;
    X_WD.reserve(configs.size());
    for (const DeviceConfig& config : configs) X_WD.push_back(config.X_WD);
    const Hand hand = plant_hand(options, X_WD, context);
    constexpr double kLarge = 1e6;  // as good as no limit
    for (size_t i = 0; i < configs.size(); ++i) {
        std::string text;
        if (backend == "openhaptics") {
            static openhaptics::FakeHd* fake = nullptr;
            if (i == 0) fake = &openhaptics::fake_hd();
            fake->hand = hand;
            openhaptics::FakeHd::Device& device = fake->devices[i];
            device.max_force = options[i].peak_force;
            device.continuous_force = options[i].continuous_force.value_or(kLarge);
            device.input_dof = options[i].orientation ? 6 : 3;
            device.output_dof = options[i].peak_torque > 0 ? 6 : 3;
            if (options[i].peak_torque > 0) device.max_torque = options[i].peak_torque * 1e3;
            const Vec3 edges = options[i].workspace.value_or(Vec3::Constant(2)) * 1e3;
            for (int axis = 0; axis < 3; ++axis) {
                // off the origin, as makers' workspaces are
                device.workspace[axis] = -0.4 * edges[axis];
                device.workspace[axis + 3] = 0.6 * edges[axis];
            }
            text = fmt::format("library: {}\nname: {}\nserial: {}\n", DIHAPTIC_FAKE_HD, device.name,
                               device.serial);
        } else {
            static forcedimension::FakeDhd* fake = nullptr;
            if (i == 0) fake = &forcedimension::fake_dhd();
            fake->hand = hand;
            fake->period = context.tick;
            forcedimension::FakeDhd::Device& device = fake->devices[i];
            device.max_force = options[i].peak_force;
            device.wrist = options[i].orientation;
            device.active_wrist = options[i].peak_torque > 0;
            device.max_torque = device.active_wrist ? options[i].peak_torque : -1;
            text = fmt::format("library: {}\nserial: {}\n", DIHAPTIC_FAKE_DHD,
                               fake->devices[i].serial);
        }
        configs[i].options = parse_yaml(text, "rig.yaml");
    }
    return find_backend(backend)->make(configs, context);
}

}  // namespace dihaptic::devices
