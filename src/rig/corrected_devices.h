// Devices whose readings are corrected by a calibration, and scaled. Both happen here and nowhere
// else.
//
// With a scale s about D's origin, the world (p_DH) and the hand (p') see
//
//     p_DH = s p'        v_DH = s v'        f' = f_DH / s
//
// so that a wall of stiffness k [N/m] in the world has k under the hand too: f' = k (s p') / s.
// Torques and angles are not scaled. A device's DeviceInfo is in the world's units: s times its
// forces, its reach and its speeds (README.md). A calibration's stretch makes some forces larger
// after they were limited: the device's own limit acts last, in the hand's units.
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
