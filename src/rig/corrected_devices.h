// Devices whose readings are corrected by a calibration and then scaled. Correction and scaling are
// done only here.
//
// With a scale s about D's origin, quantities in the world (p_DH) and at the hand (p') are related
// by
//
//     p_DH = s p'        v_DH = s v'        f' = f_DH / s
//
// so that a wall of stiffness k [N/m] in the world also has the stiffness k for the hand: f' = k (s
// p') / s. Torques and angles are not scaled. A device's DeviceInfo is in world units: its forces,
// its reach and its speeds are multiplied by s (README.md). The stretch of a calibration increases
// some forces after they have been limited; the device's own limit is applied last, in the units of
// the hand.
#pragma once

#include "rig/correction.h"

namespace dihaptic::rig {

struct Adjustment {
    Correction correction;
    double scale = 1;
};

/// `adjustments` has one entry for each device in `devices`.
std::unique_ptr<devices::DeviceGroup> make_corrected(std::unique_ptr<devices::DeviceGroup> devices,
                                                     std::vector<Adjustment> adjustments);

}  // namespace dihaptic::rig
