// Puts simulated devices, held by the simulated hand, behind a manufacturer's fake library.
#pragma once

#include <memory>

#include "devices/device_group.h"
#include "devices/simulated/plant.h"
#include "devices/test/fake_hand.h"
#include "devices/test/stand_in.h"

namespace dihaptic::devices {

/// `configs` are the configurations of simulated devices. `context.driver` must outlive the result.
inline Hand plant_hand(const std::vector<DeviceConfig>& configs, const Context& context) {
    const std::vector<simulated::Options> options = options_of(configs);
    struct Device {
        simulated::Plant plant;
        simulated::Encoder encoder;
        simulated::Gimbal gimbal;
        Pose X_WD;
    };
    auto devices = std::make_shared<std::vector<Device>>();
    for (size_t i = 0; i < options.size(); ++i) {
        devices->push_back({simulated::Plant(options[i], context.impedance, context.tremor,
                                             context.seed, static_cast<int>(i), *context.driver),
                            simulated::Encoder(options[i]), simulated::Gimbal(options[i]),
                            configs[i].X_WD});
        devices->back().plant.begin(Time(0));
    }
    return [devices](size_t i, double t, const Wrench& push) {
        Device& device = (*devices)[i];
        const Quat& R_WD = device.X_WD.R;
        const Time now = from_seconds(t);
        device.plant.hold({R_WD * push.force, R_WD * push.torque});
        device.plant.advance(now);
        const Pose X_DW = device.X_WD.inverse();
        const auto measured =
            device.encoder.measure(now, X_DW * device.plant.p_WH(), X_DW.R * device.plant.v_WH());
        const auto turned = device.gimbal.measure(now, X_DW.R * device.plant.R_WH() * R_WD,
                                                  X_DW.R * device.plant.w_WH());
        return Held{measured.p, measured.v, turned.R, turned.w};
    };
}

}  // namespace dihaptic::devices
