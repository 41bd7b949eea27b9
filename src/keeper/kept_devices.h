// The program's side of real devices owned by another process, the keeper.
//
// The keeper (keeper.h) is a small program in which nothing else runs. It takes force away when
// this program dies, stops or hangs, for any cause. README.md describes the communication between
// the two, and its times.
#pragma once

#include <memory>
#include <string>

#include "keeper/order.h"

namespace dihaptic::keeper {

/// Path of the keeper's program, which is beside this one. Throws Error if it is missing.
std::string program();

/// Starts a keeper that makes the devices of `order`. Throws Error with their backend's message.
std::unique_ptr<devices::DeviceGroup> keep_devices(const Order& order);

}  // namespace dihaptic::keeper
