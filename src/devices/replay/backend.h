// The backend `replay`, whose devices repeat a recording. Forces have no effect.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::replay {

Backend backend();

}  // namespace dihaptic::devices::replay
