// Simulated devices in the simulated hand: what experiments are rehearsed on.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::simulated {

Backend backend();

}  // namespace dihaptic::devices::simulated
