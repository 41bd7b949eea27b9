// Triangle meshes from files. A program of its own, dihaptic-mesh, reads them (docs/adr/0010): a
// damaged file may end it, and ends in an Error here.
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

/// Reads a mesh from an OBJ, STL, PLY or OFF file, one of its coordinate units being `unit` metres.
/// `asked_at` is where the file was named, for messages. Throws Error when it cannot be read, holds
/// no triangle, or takes more time or memory than meshes of its size do.
Mesh read_mesh(const std::string& file, double unit, const Place& asked_at);

/// From any thread: a mesh that is being read is given up, and whoever waits for it gets an Error.
/// Does nothing when there is none.
void cancel_reading() noexcept;

}  // namespace dihaptic::scene
