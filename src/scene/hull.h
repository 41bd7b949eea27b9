// Convex polyhedra: the convex hull of a set of points, and integrals over its volume.
#pragma once

#include <span>
#include <vector>

#include "base/geometry.h"

namespace dihaptic::scene {

/// A convex polyhedron. The vertices of each face are listed counter-clockwise, seen from outside.
struct Hull {
    std::vector<Vec3> vertices;
    std::vector<std::vector<int>> faces;
};

/// The convex hull of the points; empty if they all lie in one plane (relative thickness below
/// 1e-6).
Hull convex_hull(std::span<const Vec3> points);

/// Volume, centre and second moments of a solid of unit density.
struct VolumeIntegrals {
    double volume = 0;            ///< [m^3]
    Vec3 centre = Vec3::Zero();   ///< centre of volume [m]
    Mat3 inertia = Mat3::Zero();  ///< second moments about the centre, for unit density [m^5]
};

/// Computes integrals over the solid enclosed by outward-facing polygons, as sums over the signed
/// tetrahedra that the polygons form with the origin (moments of a tetrahedron from Tonon 2004).
/// Exact for all closed polyhedra, convex or not.
VolumeIntegrals integrate(std::span<const Vec3> vertices, std::span<const std::vector<int>> faces);

}  // namespace dihaptic::scene
