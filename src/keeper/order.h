// What the program orders from a keeper: which devices to make, and how to keep them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "devices/device_group.h"

namespace dihaptic::keeper {

/// How a keeper works.
struct Keeping {
    std::string program;            ///< the keeper's path: program() of kept_devices.h
    double longest_silence = 0.04;  ///< of the program; then force is set to zero [s]
    int priority = 80;              ///< SCHED_FIFO's, of the thread that serves the ticks
    /// Returns true when a keeper that does not answer should no longer be waited for, as after
    /// Ctrl-C. May be empty.
    std::function<bool()> given_up = {};
};

/// Which devices to make.
struct Order {
    std::string backend;
    std::vector<devices::DeviceConfig> configs;
    double tick = 1e-3;  ///< [s]
    Keeping keeping;
};

}  // namespace dihaptic::keeper
