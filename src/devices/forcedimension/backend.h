// The backend `forcedimension`: Force Dimension's devices (omega, delta, sigma) and the Novint
// Falcon, through the DHD API; see README.md.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::forcedimension {

Backend backend();

}  // namespace dihaptic::devices::forcedimension
