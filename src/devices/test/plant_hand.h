// The simulated devices in the simulated hand, behind a maker's fake library.
#pragma once

#include <memory>

#include "devices/device_group.h"
#include "devices/simulated/plant.h"
#include "devices/test/fake_hand.h"

namespace dihaptic::devices {

/// `context.driver` outlives it.
inline Hand plant_hand(const std::vector<simulated::Options>& options,
                       const std::vector<Pose>& X_WD, const Context& context) {
    struct Device {
        simulated::Plant plant;
        simulated::Encoder encoder;
        Pose X_WD;
    };
    auto devices = std::make_shared<std::vector<Device>>();
    for (size_t i = 0; i < options.size(); ++i) {
        devices->push_back({simulated::Plant(options[i], context.impedance, context.tremor,
                                             context.seed, static_cast<int>(i), *context.driver),
                            simulated::Encoder(options[i]), X_WD[i]});
        devices->back().plant.begin(Time(0));
    }
    return [devices](size_t i, double t, const Vec3& force) {
        Device& device = (*devices)[i];
        const Time now = from_seconds(t);
        device.plant.hold({device.X_WD.R * force, Vec3::Zero()});
        device.plant.advance(now);
        const Pose X_DW = device.X_WD.inverse();
        const auto measured =
            device.encoder.measure(now, X_DW * device.plant.p_WH(), X_DW.R * device.plant.v_WH());
        return Held{measured.p, measured.v, Quat::Identity(), Vec3::Zero()};
    };
}

}  // namespace dihaptic::devices
