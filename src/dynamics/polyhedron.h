// Finds contacts between convex polyhedra, and between a polyhedron and a half-space.
//
// Separating-axis test over the faces of both and the cross products of their edge directions
// (Gottschalk 1996; Gregorius 2013); then the incident face is clipped against the reference face.
// Contacts are found up to `margin` before the bodies touch, so that a solver can prevent any
// overlap: a gap g lets bodies approach by at most g in the step.
//
// Bullet finds box contacts only once they overlap, and allocates in doing so; hence this
// implementation.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "scene/hull.h"

namespace dihaptic::dynamics {

/// A convex polyhedron, prepared for contact. Built once; all vectors are in the body's frame.
struct Polyhedron {
    /// The plane through an edge of a face, perpendicular to the face.
    struct Side {
        Vec3 normal;        ///< unit, points away from the face
        double offset = 0;  ///< normal . x = offset on the plane [m]
    };
    struct Face {
        Vec3 normal;                ///< outward
        double offset = 0;          ///< normal . x = offset on the face [m]
        std::vector<int> vertices;  ///< counter-clockwise from outside
        std::vector<Side> sides;    ///< one per edge
    };
    struct Edge {
        int from = 0;
        int to = 0;
        int direction = 0;  ///< index into directions
    };
    std::vector<Vec3> vertices;
    std::vector<Face> faces;
    std::vector<Edge> edges;
    std::vector<Vec3> directions;  ///< of edges, unit; parallel ones only once
    /// Outward normals of faces that other parts of the same body cover, and which nothing can
    /// touch. Without them, a body sliding over the seam would run into the covered face behind it.
    std::vector<Vec3> covered;

    static Polyhedron of(const scene::Hull& hull);
    static Polyhedron box(const Vec3& size);

    static constexpr size_t kMostFaceVertices = 32;
};

struct ContactPoint {
    Vec3 p_WA;   ///< on A's surface [m]
    Vec3 p_WB;   ///< on B's surface [m]
    double gap;  ///< from A to B along the normal; negative: overlap [m]
    /// From this point to the point of a rolling rim that will touch in the middle of the step,
    /// without the body's own motion [m].
    Vec3 ahead_W = Vec3::Zero();
};

/// Up to four contact points with a common normal.
struct ContactPatch {
    Vec3 n_W = Vec3::UnitZ();  ///< unit, from A to B
    std::array<ContactPoint, 4> points;
    int count = 0;
};

/// Contacts with gaps up to `margin` [m]. `way_W` is the displacement of B relative to A in the
/// coming step [m]. Allocates nothing.
ContactPatch collide(const Polyhedron& a, const Pose& X_WA, const Polyhedron& b, const Pose& X_WB,
                     double margin, const Vec3& way_W = Vec3::Zero()) noexcept;

/// Contacts between the half-space below the plane z = 0 of frame A and a polyhedron, as above.
ContactPatch collide_half_space(const Pose& X_WA, const Polyhedron& b, const Pose& X_WB,
                                double margin) noexcept;

}  // namespace dihaptic::dynamics
