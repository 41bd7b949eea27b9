// Shared by polyhedron.cpp and round.cpp: polygons that are clipped to contact patches.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "dynamics/polyhedron.h"

namespace dihaptic::dynamics {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// An edge axis must separate better than the best face by this margin: faces give complete
/// patches, and near ties would make the contact flip between one point and four.
constexpr double kFacePreference = 1e-5;  // [m]

/// A polygon of fixed capacity: a face clipped by another. Two points are a line, one is a
/// point.
struct Polygon {
    std::array<Vec3, 2 * Polyhedron::kMostFaceVertices> points;
    size_t count = 0;

    void add(const Vec3& p) {
        if (count < points.size()) points[count++] = p;
    }
};

/// Gaps of a polygon's points [m].
using Gaps = std::array<double, 2 * Polyhedron::kMostFaceVertices>;

/// The part of `in` with n . x <= offset (Sutherland and Hodgman 1974).
void clip(const Polygon& in, const Vec3& n, double offset, Polygon& out);

/// Turns the patch's normal to point from B to A.
inline void flip(ContactPatch& patch) {
    patch.n_W = -patch.n_W;
    for (ContactPoint& point : patch.points) std::swap(point.p_WA, point.p_WB);
}

/// Whether a shape at a distance `separation` along a face's normal n, which moves by `way`
/// in the coming step, stands flush with that face and stays so. If it also touches an edge, the
/// face's plane is as near as that edge, and a body that slides along the plane must not run into
/// the edge. Seams between bodies side by side are therefore not felt.
inline bool is_flush(double separation, const Vec3& n, const Vec3& way) {
    constexpr double kFlush = 3e-5;  // [m]: a little more than the fall in a step
    return std::abs(separation) < kFlush && separation + n.dot(way) > -kFlush;
}

/// Whether the best axis separates shapes in a direction other than that of the face with which
/// they are flush.
inline bool is_across(const Vec3& axis, const Vec3& n_flush) {
    return axis.dot(n_flush) < 0.9;
}

/// Keeps four points that span the patch: the deepest, the one farthest from it, and on each side
/// of these two the one that makes the largest triangle with them.
void reduce(const Polygon& points, const Gaps& gaps, const Vec3& n, std::array<size_t, 4>& kept,
            int& count);

/// Adds the points on B within the margin to the patch, whose normal is known; `offset` belongs to
/// A's face.
void keep_near(const Polygon& points, double offset, double margin, ContactPatch& patch);

/// Whether another part of the same body covers the face with the normal outward_W.
bool is_covered(const Polyhedron& polyhedron, const Pose& X_WP, const Vec3& outward_W);

}  // namespace dihaptic::dynamics
