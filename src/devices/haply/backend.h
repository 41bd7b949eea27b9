// Haply Inverse3, through the Inverse Service.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::haply {

Backend backend();

}  // namespace dihaptic::devices::haply
