// The program's side of real devices that are owned by another process, the device host.
//
// The device host (host.h) is a small program in which nothing else runs. It switches the force off
// when this program crashes, stops or hangs, whatever the cause. README.md describes how the two
// communicate, and the times involved.
#pragma once

#include <memory>
#include <string>

#include "host/order.h"

namespace dihaptic::host {

/// Path of the device host's executable, which is a companion (base/companion.h). Throws Error if
/// it is missing.
std::string program();

/// Starts a device host that makes the devices of `order`. Throws Error with the backend's message
/// if that fails.
std::unique_ptr<devices::DeviceGroup> host_devices(const Order& order);

}  // namespace dihaptic::host
