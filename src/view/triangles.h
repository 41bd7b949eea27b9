// Converts the surfaces of shapes into triangles, for drawing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace dihaptic::view {

struct Vertex {
    Eigen::Vector3f p;  ///< [m]
    Eigen::Vector3f n;  ///< outward normal (unit vector)
};

/// Triangles, each with three indices in counter-clockwise order when seen from outside.
struct Triangles {
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
    /// Linear colour of each vertex, NaN for vertices without one; empty if no vertex has a colour.
    std::vector<Eigen::Vector3f> colours;

    void append(const Triangles& other, const Pose& X);
};

/// The surface of a shape, in the frame of its body. The edges of boxes, cylinders and cones are
/// rounded inward, by 1.2 mm at most, so that they reflect light. A concave mesh is drawn
/// unchanged, and any other mesh as its convex hull, so that the visible surface is the felt
/// surface. A mesh that is drawn with its own colours looks exactly as in its file. A plane is
/// drawn as a square with sides of `plane_size` [m].
Triangles triangles(const scene::Shape& shape, double plane_size = 8);
/// The visible surface of a body, i.e. of its shape or of a mesh that replaces the shape.
Triangles triangles(const scene::Body& body, double plane_size = 8);

/// A square in the plane z = 0, centred at the origin and facing up. `size`: length of its sides
/// [m].
Triangles square(double size);
/// A tube along a path, with rounded ends [m]. Empty if the path has fewer than two distinct
/// points.
Triangles tube(std::span<const Vec3> path, double radius);
/// An arrow that points from the origin along z, with the given length [m].
Triangles arrow(double length, double radius);

}  // namespace dihaptic::view
