// Devices that repeat what was recorded: forces go nowhere.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::replay {

Backend backend();

}  // namespace dihaptic::devices::replay
