// Turns the surfaces of shapes into triangles, for drawing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace dihaptic::view {

struct Vertex {
    Eigen::Vector3f p;  ///< [m]
    Eigen::Vector3f n;  ///< outward, of unit length
};

/// Triangles of three indices each, counter-clockwise seen from outside.
struct Triangles {
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
    /// Each vertex's own colour, linear, NaN if it has none; empty if no vertex has one.
    std::vector<Eigen::Vector3f> colours;

    void append(const Triangles& other, const Pose& X);
};

/// The surface of a shape in its body's frame. Edges of boxes, cylinders and cones are rounded
/// inward, by 1.2 mm at most, so that they catch light. A concave mesh is drawn unchanged, any
/// other mesh as its convex hull: the visible surface is the felt surface. A mesh whose colours are
/// drawn is drawn exactly as in its file. A plane is a square of `plane_size` [m].
Triangles triangles(const scene::Shape& shape, double plane_size = 8);
/// The visible surface of a body: its shape, or a mesh that replaces it.
Triangles triangles(const scene::Body& body, double plane_size = 8);

/// A square at z = 0 about the origin, facing up [m].
Triangles square(double size);
/// A tube along a path, with round ends [m]. Empty for fewer than two distinct points.
Triangles tube(std::span<const Vec3> path, double radius);
/// An arrow from the origin along z, of the given length [m].
Triangles arrow(double length, double radius);

}  // namespace dihaptic::view
