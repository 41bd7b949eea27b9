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
    /// Own ones of each vertex, linear, NaN where there is none; empty if no vertex has one.
    std::vector<Eigen::Vector3f> colours;

    void append(const Triangles& other, const Pose& X);
};

/// The surface of a shape in its body's frame. Edges of boxes, cylinders and cones are rounded
/// inward, by 1.2 mm at most, so that they catch light. A concave mesh is drawn as it is, any other
/// mesh as its convex hull: what is seen is what is felt. A mesh whose colours are drawn is drawn
/// as its file has it. A plane is a square of `plane_size` [m].
Triangles triangles(const scene::Shape& shape, double plane_size = 8);
/// The visible surface of a body: its shape, or a mesh in its place.
Triangles triangles(const scene::Body& body, double plane_size = 8);

/// A square at z = 0 about the origin, facing up [m].
Triangles square(double size);
/// A tube along a path, with round ends [m]. Empty for fewer than two different points.
Triangles tube(std::span<const Vec3> path, double radius);
/// An arrow from the origin along z, of the given length [m].
Triangles arrow(double length, double radius);

}  // namespace dihaptic::view
