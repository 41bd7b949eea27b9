// The program's side of real devices that another process, the keeper, owns.
//
// The keeper (keeper.h) is a small program in which nothing else runs. It takes force away when
// this program dies, stops or hangs, whatever the cause. README.md says what passes between the
// two, and how long it takes.
#pragma once

#include <memory>
#include <string>

#include "keeper/order.h"

namespace dihaptic::keeper {

/// Path of the keeper's program, which lies beside this one. Throws Error when it is not there.
std::string program();

/// Starts a keeper that makes the devices of `order`. Throws Error with what their backend says.
std::unique_ptr<devices::DeviceGroup> keep_devices(const Order& order);

}  // namespace dihaptic::keeper
