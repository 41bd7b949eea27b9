// The backend `forcedimension`, for Force Dimension's devices (omega, delta, sigma) and the Novint
// Falcon; it uses the DHD API (see README.md).
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::forcedimension {

Backend backend();

}  // namespace dihaptic::devices::forcedimension
