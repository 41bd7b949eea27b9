// Devices whose readings are corrected by a calibration, and scaled: the one place where both
// happen.
//
// With scale s, and D's origin where it is, hand and world see
//
//     p_DH = s p'        v_DH = s v'        f' = f_DH / s
//
// so that a wall of k [N/m] in the world is one of k under the hand too: f' = k (s p') / s. Torques
// and angles stay as they are. What a device can do is told in the world's measure: s times its
// forces, its reach and its speeds (README.md). A calibration's stretch makes some forces larger
// than what was limited before: the device's own limit is the last, in the hand's measure.
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
