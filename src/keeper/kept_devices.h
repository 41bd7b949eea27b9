// Real devices that another process owns: what the program sees of them.
//
// The keeper (keeper.h) is a small program that nothing else runs in. It takes force away when this
// program dies, stops or hangs, whatever kills it. README.md says what passes between the two, and
// how long it takes.
#pragma once

#include <memory>
#include <string>

#include "keeper/order.h"

namespace dihaptic::keeper {

/// Path of the keeper's program, which lies beside this one. Throws Error when it is not there.
std::string program();

/// The devices of `order`, made by a keeper of their own. Throws Error with what the backend says.
std::unique_ptr<devices::DeviceGroup> keep_devices(const Order& order);

}  // namespace dihaptic::keeper
