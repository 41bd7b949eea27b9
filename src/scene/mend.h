// Mends the surfaces of meshes: merges corners that differ only by rounding, drops faces without
// area, and divides an edge at each corner of another face that lies on it.
#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "scene/mesh.h"

namespace dihaptic::scene {

using Edge = std::pair<int, int>;  ///< from one vertex to another, in a face's order

inline const Vec3& corner(const Mesh& mesh, int i) {
    return mesh.vertices[static_cast<size_t>(i)];
}

/// For each edge that is not balanced by faces in the other direction: the number of excess faces
/// in this direction.
std::map<Edge, int> open_edges(const Mesh& mesh);

/// Corners closer than this are merged [m]: a millionth of the mesh's diagonal, and eight steps of
/// a coordinate in single precision.
double rounding_of(const Mesh& mesh);

/// The mesh without colours, with corners at equal positions merged, and without faces that repeat
/// a corner or lie back to back.
Mesh merged(const Mesh& mesh);

struct Mended {
    Mesh mesh;
    double largest = 0;  ///< largest distance between merged corners [m]
};

/// The mesh with all these repairs, within `rounding`.
Mended mended(const Mesh& mesh, double rounding);

}  // namespace dihaptic::scene
