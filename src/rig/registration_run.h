// Records the touches for a registration, made by a person's finger or, on simulated devices, by a
// simulated finger.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rig/calibration_guide.h"

namespace dihaptic::rig {

/// Parameters of a simulated finger that touches a screen.
struct SimulatedTouch {
    double noise = 0.3e-3;  ///< standard deviation of the touched position along each axis [m]
    uint64_t seed = 1;
};

/// Returns the positions at which a finger touched the crosses on the display, in the world and in
/// the hand's units [m]. On simulated devices, a simulated finger touches the display at its
/// position `seen`. `finger` is the touching finger. Throws Error in the same cases as
/// make_devices(), and if a device does not answer or reach a cross. Passes on exceptions from
/// `guide`.
std::vector<Vec3> lead_registration(const Rig& rig, const std::string& finger,
                                    const display::Display& seen, const Guide& guide,
                                    const SimulatedTouch& simulated = {});

}  // namespace dihaptic::rig
