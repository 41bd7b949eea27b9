// The backend `simulated`, whose devices are held by the simulated hand. Experiments are rehearsed
// with them.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::simulated {

Backend backend();

}  // namespace dihaptic::devices::simulated
