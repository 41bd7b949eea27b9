// Where a recorded hand closed on its object: far from where the hand started, and after the
// fingers had been open wider, the 0.3 s in which thumb and index moved least.
#pragma once

#include <optional>

#include "hand/repair.h"

namespace dihaptic::hand {

struct GraspSite {
    double start = 0;  ///< of the quiet stretch, from the path's beginning [s]
    double end = 0;
    Vec3 centre = Vec3::Zero();  ///< midway between the fingers [m]
    Vec3 axis = Vec3::UnitX();   ///< from the first finger (thumb) to the second; unit
    double aperture = 0;         ///< distance between the fingers [m]
    double peak_aperture = 0;    ///< before it [m]
};

/// Finds the grasp; nothing when the fingers never open and close away from the start. With `at`
/// given [s], it is the stretch around that moment.
std::optional<GraspSite> find_grasp(const Path& path, std::optional<double> at = std::nullopt);

}  // namespace dihaptic::hand
