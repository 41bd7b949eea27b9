// Simulated devices behind the fake Inverse Service, which runs one tick per message.
#pragma once

#include "devices/haply/test/fake_service.h"
#include "devices/test/stand_in.h"

namespace dihaptic::devices::haply {

inline StandIn stand_in() {
    return {"haply", [](std::vector<DeviceConfig> configs, const Context& context) {
                FakeService::Setup setup;
                setup.devices = configs;
                const auto service = std::make_shared<FakeService>(setup, context);
                // a long time-out, for busy machines
                return StandIn::Made{rig_of(*service, configs, "time_out_ms: 1000, "), service};
            }};
}

}  // namespace dihaptic::devices::haply
