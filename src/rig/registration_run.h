// Takes the touches of a registration, by a person's finger or, on simulated devices, by a
// simulated one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rig/calibration_guide.h"

namespace dihaptic::rig {

/// How a simulated finger touches a screen.
struct SimulatedTouch {
    double noise = 0.3e-3;  ///< standard deviation along each axis [m]
    uint64_t seed = 1;
};

/// The places where a finger touched the display's crosses, in the world and in the hand's units
/// [m]. On simulated devices a simulated finger touches the display at its place `seen`. `finger`:
/// the one that touches. Throws Error as make_devices() does, and when a device does not answer or
/// reach; and what `guide` throws.
std::vector<Vec3> lead_registration(const Rig& rig, const std::string& finger,
                                    const display::Display& seen, const Guide& guide,
                                    const SimulatedTouch& simulated = {});

}  // namespace dihaptic::rig
