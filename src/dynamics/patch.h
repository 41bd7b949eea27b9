// Shared by polyhedron.cpp and round.cpp: the clipping of polygons to contact patches.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "dynamics/polyhedron.h"

namespace dihaptic::dynamics {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Margin by which an edge axis must separate shapes better than the best face axis. Faces are
/// preferred because they give complete patches, and because near ties would make the contact flip
/// between one point and four.
constexpr double kFacePreference = 1e-5;  // [m]

/// A polygon of fixed capacity, e.g. a face clipped by another face. Two points represent a line;
/// one represents a point.
struct Polygon {
    std::array<Vec3, 2 * Polyhedron::kMostFaceVertices> points;
    size_t count = 0;

    void add(const Vec3& p) {
        if (count < points.size()) points[count++] = p;
    }
};

/// The gap at each point of a polygon [m].
using Gaps = std::array<double, 2 * Polyhedron::kMostFaceVertices>;

/// Computes the part of `in` with n . x <= offset (Sutherland and Hodgman 1974).
void clip(const Polygon& in, const Vec3& n, double offset, Polygon& out);

/// Reverses the patch's normal, so that it points from B to A, and swaps the points of A and B.
inline void flip(ContactPatch& patch) {
    patch.n_W = -patch.n_W;
    for (ContactPoint& point : patch.points) std::swap(point.p_WA, point.p_WB);
}

/// Whether a shape that is `separation` away along a face's normal n, and moves by `way` in the
/// coming step, is flush with that face and remains so. If the shape also touches an edge, the
/// face's plane is as near as that edge, and a body that slides along the plane must not run into
/// the edge. This makes seams between adjacent bodies imperceptible.
inline bool is_flush(double separation, const Vec3& n, const Vec3& way) {
    constexpr double kFlush = 3e-5;  // [m], slightly more than the fall in a step
    return std::abs(separation) < kFlush && separation + n.dot(way) > -kFlush;
}

/// Whether the direction of the best separating axis differs from the normal of the face with which
/// the shapes are flush.
inline bool is_across(const Vec3& axis, const Vec3& n_flush) {
    return axis.dot(n_flush) < 0.9;
}

/// Keeps four points that span the patch: the deepest point, the point farthest from it, and the
/// two points, one on each side of these, that form the largest triangles with them.
void reduce(const Polygon& points, const Gaps& gaps, const Vec3& n, std::array<size_t, 4>& kept,
            int& count);

/// Adds those points on B that are within the margin to the patch, whose normal must be set.
/// `offset` is that of A's face along this normal.
void keep_near(const Polygon& points, double offset, double margin, ContactPatch& patch);

/// Whether the face with the normal outward_W is covered by another part of the same body.
bool is_covered(const Polyhedron& polyhedron, const Pose& X_WP, const Vec3& outward_W);

}  // namespace dihaptic::dynamics
