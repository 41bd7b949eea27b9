// What a keeper has to know: which devices it is to make, and how it is to keep them.
#pragma once

#include <string>
#include <vector>

#include "devices/device_group.h"

namespace dihaptic::keeper {

/// How a keeper is to work.
struct Keeping {
    std::string program;            ///< kept_devices.h finds it
    double longest_silence = 0.04;  ///< of the program, after which force goes [s]
    int priority = 80;              ///< SCHED_FIFO's, of what serves the ticks
};

/// Which devices it is to make.
struct Order {
    std::string backend;
    std::vector<devices::DeviceConfig> configs;
    double tick = 1e-3;  ///< [s]
    Keeping keeping;
};

}  // namespace dihaptic::keeper
