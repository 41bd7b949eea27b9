// Presents the simulated devices of a benchmark as Inverse3 devices behind a fake service.
#pragma once

#include "devices/haply/test/fake_service.h"
#include "measure/plant.h"

namespace dihaptic::measure {

/// The service advances one tick with each message, so time passes as on the virtual clock. Each
/// benchmark that is created gets a new service, which is stored in `service`.
inline BenchSetup through_haply(BenchSetup setup,
                                std::unique_ptr<devices::haply::FakeService>& service) {
    setup.make_devices = [&service](const std::vector<devices::DeviceConfig>& simulated,
                                    const devices::Context& context) {
        devices::haply::FakeService::Setup served;
        served.devices = simulated;
        service = std::make_unique<devices::haply::FakeService>(served, context);
        // the peak force of the simulated devices, and a long time-out for busy machines
        return devices::find_backend("haply")->make(
            rig_of(*service, simulated, "peak_force_N: 8.5, time_out_ms: 1000, "), context);
    };
    return setup;
}

}  // namespace dihaptic::measure
