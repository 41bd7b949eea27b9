// Devices whose readings are corrected by a calibration, and scaled. Both are done only
// here.
//
// With a scale s about D's origin, world (p_DH) and hand (p') are related by
//
//     p_DH = s p'        v_DH = s v'        f' = f_DH / s
//
// so that a wall of stiffness k [N/m] in the world has k under the hand as well: f' = k (s p') / s.
// Torques and angles are not scaled. A device's DeviceInfo is in the world's units: s times its
// forces, its reach and its speeds (README.md). A calibration's stretch makes some forces larger
// after their limits; the device's own limit acts last, in the hand's units.
#pragma once

#include "rig/correction.h"

namespace dihaptic::rig {

struct Adjustment {
    Correction correction;
    double scale = 1;
};

/// `adjustments`: one for each device of `devices`.
std::unique_ptr<devices::DeviceGroup> make_corrected(std::unique_ptr<devices::DeviceGroup> devices,
                                                     std::vector<Adjustment> adjustments);

}  // namespace dihaptic::rig
