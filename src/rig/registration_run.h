// Takes the touches of a registration, by a person's finger or, on simulated devices, by a
// simulated one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rig/calibration_guide.h"

namespace dihaptic::rig {

/// Parameters of a simulated finger that touches a screen.
struct SimulatedTouch {
    double noise = 0.3e-3;  ///< standard deviation along each axis [m]
    uint64_t seed = 1;
};

/// The positions at which a finger touched the display's crosses, in the world and in the hand's
/// units [m]. On simulated devices a simulated finger touches the display at its position `seen`.
/// `finger`: the touching finger. Throws Error like make_devices(), and if a device does not answer
/// or reach a cross; passes on exceptions of `guide`.
std::vector<Vec3> lead_registration(const Rig& rig, const std::string& finger,
                                    const display::Display& seen, const Guide& guide,
                                    const SimulatedTouch& simulated = {});

}  // namespace dihaptic::rig
