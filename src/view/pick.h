// Finds the body at which a person points in a picture, and its displacement when it is dragged.
#pragma once

#include <optional>

#include "frame/frame.h"
#include "view/camera.h"

namespace dihaptic::view {

/// A straight line of sight.
struct Ray {
    Vec3 from_W = Vec3::Zero();
    Vec3 along_W = Vec3::UnitY();  ///< direction, of unit length
};
/// The line of sight through a point in the camera's picture: `right` and `up` from its middle, as
/// shares of half its height.
Ray ray_through(const Camera& camera, double right, double up);

/// The first visible body along a ray, as drawn; nullopt: none.
struct Seen {
    size_t body = 0;  ///< its index
    Vec3 p_W = Vec3::Zero();
};
std::optional<Seen> seen_first(const scene::Scene& scene, const frame::Frame& frame,
                               const Ray& ray);

/// The displacement of a body held at a point while the line of sight to the pointer changes from
/// one to the other: in the table's plane or, if `upright`, along z [m]. Nullopt if the point is
/// beyond the visible part of the plane.
std::optional<Vec3> dragged(const Vec3& held_W, const Ray& from, const Ray& to, bool upright);

}  // namespace dihaptic::view
