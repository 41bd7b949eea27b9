// Presents the bench's simulated devices as Inverse3 devices behind a fake service.
#pragma once

#include "devices/haply/test/fake_service.h"
#include "measure/plant.h"

namespace dihaptic::measure {

/// The service ticks with each message, so time passes as on the virtual clock. Each bench that is
/// made gets a new service, which is kept in `service`.
inline BenchSetup through_haply(BenchSetup setup,
                                std::unique_ptr<devices::haply::FakeService>& service) {
    setup.make_devices = [&service](const std::vector<devices::DeviceConfig>& simulated,
                                    const devices::Context& context) {
        devices::haply::FakeService::Setup served;
        served.devices = simulated;
        service = std::make_unique<devices::haply::FakeService>(served, context);
        // the force of the simulated devices, and a long time-out for busy machines
        return devices::find_backend("haply")->make(
            rig_of(*service, simulated, "peak_force_N: 8.5, time_out_ms: 1000, "), context);
    };
    return setup;
}

}  // namespace dihaptic::measure
