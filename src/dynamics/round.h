// Finds contacts of spheres, capsules, cylinders and cones: with each other, with convex polyhedra
// and with a half-space.
//
// As for polyhedra (polyhedron.h), an axis is sought along which the shapes are furthest apart:
// among the normals of faces and of the caps of cylinders and cones, directions between the closest
// points of axes, edges and rims, and those in which the side of a cone looks. How far apart they
// are along an axis follows from their support functions, exactly. The patch is what both have
// nearest along that axis: a point, the line along which a cylinder or a cone lies, or a cap,
// clipped against the face that it meets. All points are found anew in each step: a point that
// rolls along with the body would be one that no longer touches.
#pragma once

#include "dynamics/polyhedron.h"

namespace dihaptic::dynamics {

/// A sphere, capsule, cylinder or cone about the z axis of its frame.
struct Round {
    enum class Ends { round, flat, tip };  ///< tip: flat below, and a tip at the top of z
    double radius = 0;                     ///< [m]
    double half = 0;  ///< from the middle to a cap, a tip, or the centre of a round end [m]
    Ends ends = Ends::round;

    bool has_rim() const { return ends != Ends::round; }
    bool is_cone() const { return ends == Ends::tip; }
};

/// As collide() of polyhedra. `turn_W` is by how much B turns against A in the coming step [rad].
ContactPatch collide(const Polyhedron& a, const Pose& X_WA, const Round& b, const Pose& X_WB,
                     double margin, const Vec3& way_W, const Vec3& turn_W = Vec3::Zero()) noexcept;
ContactPatch collide(const Round& a, const Pose& X_WA, const Round& b, const Pose& X_WB,
                     double margin) noexcept;

/// As collide_half_space() of a polyhedron.
ContactPatch collide_half_space(const Pose& X_WA, const Round& b, const Pose& X_WB, double margin,
                                const Vec3& turn_W = Vec3::Zero()) noexcept;

}  // namespace dihaptic::dynamics
