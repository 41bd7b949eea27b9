// Which body a person points at in a picture.
#pragma once

#include <optional>

#include "servo/frame.h"
#include "view/camera.h"

namespace dihaptic::view {

/// A straight line of sight.
struct Ray {
    Vec3 from_W = Vec3::Zero();
    Vec3 along_W = Vec3::UnitY();  ///< of unit length
};
/// The line of sight through a place of the camera's picture: `right` and `up` from its middle, as
/// shares of half its height.
Ray ray_through(const Camera& camera, double right, double up);

/// Index of the body that is seen first along a ray, as it is drawn; nullopt: none.
std::optional<size_t> seen_first(const scene::Scene& scene, const servo::Frame& frame,
                                 const Ray& ray);

}  // namespace dihaptic::view
