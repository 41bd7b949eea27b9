// Finds contacts between convex polyhedra, and between a polyhedron and a half-space.
//
// A separating-axis test examines the face normals of both polyhedra and the cross products of
// their edge directions (Gottschalk 1996; Gregorius 2013); then the incident face is clipped
// against the reference face. Contacts are found at up to a distance of `margin` before the bodies
// touch, so that a solver can prevent any overlap: a gap g lets bodies approach by at most g in the
// step.
//
// This implementation exists because Bullet finds contacts between boxes only once they overlap,
// and allocates memory in doing so.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "scene/hull.h"

namespace dihaptic::dynamics {

/// A convex polyhedron, prepared for finding contacts. Built once; all vectors are in the body's
/// frame.
struct Polyhedron {
    /// The plane through an edge of a face that is perpendicular to the face.
    struct Side {
        Vec3 normal;        ///< unit vector, points away from the face
        double offset = 0;  ///< normal . x = offset for points x on the plane [m]
    };
    struct Face {
        Vec3 normal;                ///< outward
        double offset = 0;          ///< normal . x = offset for points x on the face [m]
        std::vector<int> vertices;  ///< counter-clockwise as seen from outside
        std::vector<Side> sides;    ///< one per edge of the face
    };
    struct Edge {
        int from = 0;
        int to = 0;
        int direction = 0;  ///< index into directions
    };
    std::vector<Vec3> vertices;
    std::vector<Face> faces;
    std::vector<Edge> edges;
    std::vector<Vec3> directions;  ///< unit edge directions; parallel edges share one
    /// Outward normals of the faces that are covered by other parts of the same body, so that
    /// nothing can touch them. Without this information, a body sliding over the seam would run
    /// into the covered face behind it.
    std::vector<Vec3> covered;

    static Polyhedron of(const scene::Hull& hull);
    static Polyhedron box(const Vec3& size);

    static constexpr size_t kMostFaceVertices = 32;
};

struct ContactPoint {
    Vec3 p_WA;   ///< on the surface of A [m]
    Vec3 p_WB;   ///< on the surface of B [m]
    double gap;  ///< from A to B along the normal, negative if the shapes overlap [m]
    /// Vector from this point to the point of a rolling rim that will touch in the middle of the
    /// step, without the body's linear motion [m].
    Vec3 ahead_W = Vec3::Zero();
};

/// Up to four contact points with a common normal.
struct ContactPatch {
    Vec3 n_W = Vec3::UnitZ();  ///< unit vector, from A to B
    std::array<ContactPoint, 4> points;
    int count = 0;
    /// If there are no points: a distance that the shapes certainly keep, if greater than 0 [m].
    double apart = 0;
};

/// An empty patch of shapes that are at least `apart` away from each other [m].
inline ContactPatch no_contact(double apart) noexcept {
    ContactPatch out;
    out.apart = apart;
    return out;
}

/// Finds contacts with gaps of up to `margin` [m]. `way_W` is the displacement of B relative to A
/// in the coming step [m]. Does not allocate.
ContactPatch collide(const Polyhedron& a, const Pose& X_WA, const Polyhedron& b, const Pose& X_WB,
                     double margin, const Vec3& way_W = Vec3::Zero()) noexcept;

/// Finds contacts between a polyhedron and the half-space below the plane z = 0 of frame A, with
/// gaps of up to `margin` [m].
ContactPatch collide_half_space(const Pose& X_WA, const Polyhedron& b, const Pose& X_WB,
                                double margin) noexcept;

}  // namespace dihaptic::dynamics
