// Finds the position at which a recorded hand closed on its object: the 0.3 s in which thumb and
// index finger moved least, far from the hand's start and after the fingers had been farther apart.
#pragma once

#include <optional>

#include "hand/repair.h"

namespace dihaptic::hand {

struct GraspSite {
    double start = 0;  ///< start of the quiet stretch, from the start of the path [s]
    double end = 0;
    Vec3 centre = Vec3::Zero();  ///< midpoint between the fingers [m]
    Vec3 axis = Vec3::UnitX();   ///< unit vector from the first finger (thumb) to the second
    double aperture = 0;         ///< distance between the fingers [m]
    double peak_aperture = 0;    ///< largest aperture before the stretch [m]
};

/// Finds the grasp. Returns nullopt if the fingers never open and close away from the start. If
/// `at` [s] is given, the stretch around that time is taken as the grasp.
std::optional<GraspSite> find_grasp(const Path& path, std::optional<double> at = std::nullopt);

}  // namespace dihaptic::hand
