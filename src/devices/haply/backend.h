// The backend `haply`: Haply Inverse3 devices, through Haply's Inverse Service; see README.md.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::haply {

Backend backend();

}  // namespace dihaptic::devices::haply
