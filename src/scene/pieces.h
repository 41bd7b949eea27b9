// Cuts concave meshes into convex pieces, for contact. The pieces fill the mesh exactly. A separate
// program, dihaptic-decompose, cuts the mesh (docs/adr/0008), and a file beside the mesh keeps the
// pieces.
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "scene/hull.h"
#include "scene/mesh.h"

namespace dihaptic::scene {

struct Pieces {
    std::vector<Hull> hulls;  ///< in the mesh's frame [m]
    uint64_t mesh = 0;        ///< fingerprint of the mesh that was cut, in metres
};

/// The mesh with vertices at equal positions merged and all faces facing outward. Throws Error when
/// the surface is not closed, as it then has no inside. `asked_at` is where `file` was named, for
/// messages.
Mesh closed(const Mesh& mesh, const std::string& file, const Place& asked_at);

/// Convex pieces of a closed mesh that was read from `file`. The pieces kept beside the file are
/// used if they are intact and belong to this mesh; else the mesh is cut and the new pieces are
/// kept. Warns if they cannot be written. Throws Error when the mesh cannot be cut, e.g. because it
/// intersects itself, or when the cut is stopped.
Pieces convex_pieces(const Mesh& mesh, const std::string& file, const Place& asked_at,
                     Diagnostics& diagnostics, const std::stop_token& stop = {});

/// Name of the file beside a mesh that keeps its pieces.
std::string pieces_file(const std::string& mesh_file);
/// Writes pieces to a file. Throws Error when the file cannot be written.
void write_pieces(const Pieces& pieces, const std::string& file);

}  // namespace dihaptic::scene
