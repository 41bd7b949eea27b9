// Triangle meshes from files (OBJ, STL, PLY and what else assimp reads).
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/geometry.h"

namespace dihaptic::scene {

/// Triangles, counter-clockwise seen from outside.
struct Mesh {
    std::vector<Vec3> vertices;           ///< [m]
    std::vector<std::vector<int>> faces;  ///< three vertices each
};

/// Reads a mesh, one of its coordinate units being `unit` metres. `asked_at` is where the file was
/// named, for messages. Throws Error when it cannot be read or holds no triangle.
Mesh read_mesh(const std::string& file, double unit, const Place& asked_at);

}  // namespace dihaptic::scene
