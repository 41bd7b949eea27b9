// What the program orders a device host to do: the devices to make, and the rules for owning them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "devices/device_group.h"

namespace dihaptic::host {

/// The settings of a device host.
struct Hosting {
    std::string program;            ///< path of the device host: program() in hosted_devices.h
    double longest_silence = 0.04;  ///< silence after which force is set to zero [s]
    int priority = 80;              ///< SCHED_FIFO priority of the thread that serves the ticks
    /// Returns true to stop waiting for a device host that does not answer, e.g. after Ctrl-C. May
    /// be empty.
    std::function<bool()> given_up = {};
};

/// The devices to make.
struct Order {
    std::string backend;
    std::vector<devices::DeviceConfig> configs;
    double tick = 1e-3;  ///< [s]
    Hosting hosting;
};

}  // namespace dihaptic::host
