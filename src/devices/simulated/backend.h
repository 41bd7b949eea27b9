// The backend `simulated`: devices held by the simulated hand, on which experiments are rehearsed.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::simulated {

Backend backend();

}  // namespace dihaptic::devices::simulated
