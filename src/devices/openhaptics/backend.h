// The backend `openhaptics`, for devices by 3D Systems and SensAble (PHANToM Premium, Touch, Omni);
// it uses OpenHaptics' HD API (see README.md).
#pragma once

#include "devices/device_group.h"

namespace dihaptic::devices::openhaptics {

Backend backend();

}  // namespace dihaptic::devices::openhaptics
