// The backend `haply`, for Haply Inverse3 devices, which it reaches through Haply's Inverse Service
// (see README.md).
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::haply {

Backend backend();

}  // namespace dihaptic::devices::haply
