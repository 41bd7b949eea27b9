// Contact between convex polyhedra, and between a polyhedron and a half space.
//
// Separating-axis test over the faces of both and the cross products of their edge directions
// (Gottschalk 1996; Gregorius 2013), then the incident face clipped to the reference face. Contacts
// are found up to `margin` before they touch, so that a solver can keep bodies from ever
// overlapping: a gap g lets them approach by g in the step, no more.
//
// Bullet finds box contacts only once they overlap, and allocates on the way; hence this.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "scene/hull.h"

namespace dihaptic::dynamics {

/// A convex polyhedron, prepared for contact. Built once; frames are the body's.
struct Polyhedron {
    /// The plane through an edge of a face, at a right angle to the face.
    struct Side {
        Vec3 normal;        ///< unit, leaves the face
        double offset = 0;  ///< normal . x = offset on the plane [m]
    };
    struct Face {
        Vec3 normal;                ///< outward
        double offset = 0;          ///< normal . x = offset on the face [m]
        std::vector<int> vertices;  ///< counter-clockwise from outside
        std::vector<Side> sides;    ///< one an edge
    };
    struct Edge {
        int from = 0;
        int to = 0;
        int direction = 0;  ///< index into directions
    };
    std::vector<Vec3> vertices;
    std::vector<Face> faces;
    std::vector<Edge> edges;
    std::vector<Vec3> directions;  ///< of edges, unit, without parallel ones
    /// Outward normals of faces that other parts of the same body cover: nothing touches them. What
    /// slides over the seam would else run into the face behind it.
    std::vector<Vec3> covered;

    static Polyhedron of(const scene::Hull& hull);
    static Polyhedron box(const Vec3& size);

    static constexpr size_t kMostFaceVertices = 32;
};

struct ContactPoint {
    Vec3 p_WA;   ///< on A's surface [m]
    Vec3 p_WB;   ///< on B's surface [m]
    double gap;  ///< from A to B along the normal; negative: overlap [m]
};

/// At most four points share one normal.
struct ContactPatch {
    Vec3 n_W = Vec3::UnitZ();  ///< unit, from A to B
    std::array<ContactPoint, 4> points;
    int count = 0;
};

/// Contacts with gaps up to `margin` [m]. Allocates nothing.
ContactPatch collide(const Polyhedron& a, const Pose& X_WA, const Polyhedron& b, const Pose& X_WB,
                     double margin) noexcept;

/// The same against the half space below the plane z = 0 of frame A.
ContactPatch collide_half_space(const Pose& X_WA, const Polyhedron& b, const Pose& X_WB,
                                double margin) noexcept;

}  // namespace dihaptic::dynamics
