// Finds contacts of spheres, capsules, cylinders and cones with each other, with convex polyhedra
// and with a half-space.
//
// As for polyhedra (polyhedron.h), we look for the axis along which the shapes are farthest apart:
// among the normals of faces and of the caps of cylinders and cones, the directions between the
// closest points of axes, edges and rims, and the normals of the side of a cone. The distance along
// an axis follows exactly from the support functions. The patch consists of the nearest features
// along that axis: a point, the line along which a cylinder or a cone lies, or a cap, clipped
// against the face that it meets. All points are found anew in each step, because a point that
// rolls along with the body would no longer touch.
#pragma once

#include "dynamics/polyhedron.h"

namespace dihaptic::dynamics {

/// A sphere, capsule, cylinder or cone whose axis is the z axis of its frame.
struct Round {
    enum class Ends { round, flat, tip };  ///< tip: flat at the bottom, with a tip at the top (+z)
    double radius = 0;                     ///< [m]
    double half = 0;  ///< from the middle to a cap, a tip, or the centre of a round end [m]
    Ends ends = Ends::round;

    bool has_rim() const { return ends != Ends::round; }
    bool is_cone() const { return ends == Ends::tip; }
};

/// Like collide() for two polyhedra. `turn_W` is the rotation of B relative to A in the coming step
/// [rad].
ContactPatch collide(const Polyhedron& a, const Pose& X_WA, const Round& b, const Pose& X_WB,
                     double margin, const Vec3& way_W, const Vec3& turn_W = Vec3::Zero()) noexcept;
ContactPatch collide(const Round& a, const Pose& X_WA, const Round& b, const Pose& X_WB,
                     double margin) noexcept;

/// Like collide_half_space() for a polyhedron.
ContactPatch collide_half_space(const Pose& X_WA, const Round& b, const Pose& X_WB, double margin,
                                const Vec3& turn_W = Vec3::Zero()) noexcept;

}  // namespace dihaptic::dynamics
