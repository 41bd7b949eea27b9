// Finds the body that a person points at in a picture, and the displacement of a body that is
// dragged.
#pragma once

#include <optional>

#include "frame/frame.h"
#include "view/camera.h"

namespace dihaptic::view {

/// A straight line of sight.
struct Ray {
    Vec3 from_W = Vec3::Zero();
    Vec3 along_W = Vec3::UnitY();  ///< direction (unit vector)
};
/// The line of sight through a point in the camera's picture. `right` and `up` are measured from
/// the middle of the picture, as shares of half its height.
Ray ray_through(const Camera& camera, double right, double up);

/// The first visible body along a ray, as displayed; seen_first() returns nullopt if there is none.
struct Seen {
    size_t body = 0;  ///< its index
    Vec3 p_W = Vec3::Zero();
};
std::optional<Seen> seen_first(const scene::Scene& scene, const frame::Frame& frame,
                               const Ray& ray);

/// The displacement of a body that is held at a point while the line of sight to the pointer
/// changes from `from` to `to` [m]: in the plane of the table or, if `upright`, along z. Returns
/// nullopt if the point would be beyond the visible part of the plane.
std::optional<Vec3> dragged(const Vec3& held_W, const Ray& from, const Ray& to, bool upright);

}  // namespace dihaptic::view
