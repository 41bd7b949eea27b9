// Mends the surfaces of meshes: merges corners that differ only by rounding, removes faces without
// area, and divides an edge at each corner of another face that lies on the edge.
#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "scene/mesh.h"

namespace dihaptic::scene {

using Edge = std::pair<int, int>;  ///< from one vertex to the next, in a face's order

inline const Vec3& corner(const Mesh& mesh, int i) {
    return mesh.vertices[static_cast<size_t>(i)];
}

/// The edges at which the numbers of faces in the two directions differ. For each, gives the number
/// of excess faces in the edge's direction.
std::map<Edge, int> open_edges(const Mesh& mesh);

/// Corners that are closer together than this are merged [m]: a millionth of the mesh's diagonal or
/// eight steps of a single-precision coordinate, whichever is larger.
double rounding_of(const Mesh& mesh);

/// Returns the mesh without colours, with corners at equal positions merged, and without faces that
/// repeat a corner or lie back to back.
Mesh merged(const Mesh& mesh);

struct Mended {
    Mesh mesh;
    double largest = 0;  ///< largest distance between corners that were merged [m]
};

/// Returns the mesh with all these repairs made, where distances of up to `rounding` are treated as
/// zero.
Mended mended(const Mesh& mesh, double rounding);

}  // namespace dihaptic::scene
