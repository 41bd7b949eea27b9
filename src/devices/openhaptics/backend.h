// The backend `openhaptics`: devices of 3D Systems and SensAble (PHANToM Premium, Touch, Omni),
// through OpenHaptics' HD API; see README.md.
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::openhaptics {

Backend backend();

}  // namespace dihaptic::devices::openhaptics
