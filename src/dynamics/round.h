// Finds contacts of spheres, capsules and cylinders: with each other, with convex polyhedra and
// with a half-space.
//
// As for polyhedra (polyhedron.h), an axis is sought along which the shapes are furthest apart:
// among the normals of faces and of a cylinder's caps, and directions between the closest points of
// axes, edges and rims. How far apart they are along an axis follows from their support functions,
// exactly. The patch is what both have nearest along that axis: a point, the line along which a
// cylinder lies, or a cap, clipped against the face that it meets. All points are found anew in
// each step: a point that rolls along with the body would be one that no longer touches.
#pragma once

#include "dynamics/polyhedron.h"

namespace dihaptic::dynamics {

/// A sphere, capsule or cylinder about the z axis of its frame.
struct Round {
    double radius = 0;         ///< [m]
    double half = 0;           ///< from the middle to a cap, or to the centre of a round end [m]
    bool is_cylinder = false;  ///< its ends are flat
};

/// As collide() of polyhedra.
ContactPatch collide(const Polyhedron& a, const Pose& X_WA, const Round& b, const Pose& X_WB,
                     double margin, const Vec3& way_W) noexcept;
ContactPatch collide(const Round& a, const Pose& X_WA, const Round& b, const Pose& X_WB,
                     double margin) noexcept;

/// As collide_half_space() of a polyhedron.
ContactPatch collide_half_space(const Pose& X_WA, const Round& b, const Pose& X_WB,
                                double margin) noexcept;

}  // namespace dihaptic::dynamics
