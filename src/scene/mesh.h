// Reads triangle meshes from files. A separate program, dihaptic-mesh, does the reading
// (docs/adr/0010): a damaged file may crash it, which ends in an Error here.
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

/// Reads a mesh from an OBJ, STL, PLY or OFF file whose coordinates are in units of `unit` metres.
/// `asked_at` is where the file was named, for messages. Throws Error when the file cannot be read,
/// holds no triangle, or takes more time or memory than good meshes of its size do.
Mesh read_mesh(const std::string& file, double unit, const Place& asked_at);

/// Stops the reading of meshes: each read_mesh() in progress throws Error. Does nothing if none is
/// in progress. May be called from any thread.
void cancel_reading() noexcept;

}  // namespace dihaptic::scene
