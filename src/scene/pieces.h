// Cuts concave meshes into convex pieces, for contact. The pieces fill the mesh exactly, which is
// checked by comparing volume and extent. A separate program, dihaptic-decompose, cuts the mesh
// (docs/adr/0008), and the pieces are stored in a file.
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "scene/hull.h"
#include "scene/mesh.h"

namespace dihaptic::scene {

struct ClosedMesh;
struct MeshName;

struct Pieces {
    std::vector<Hull> hulls;  ///< the pieces, in the mesh's frame [m]
    uint64_t mesh = 0;        ///< fingerprint of the mesh that was cut, computed in metres
};

/// Integrals over all the pieces, for unit density.
VolumeIntegrals integrate(const Pieces& pieces);

/// Returns convex pieces of a closed mesh. Stored pieces are used if they are intact, belong to
/// this mesh and fill it; otherwise, the mesh is cut and the new pieces are stored. If shells
/// overlap, the pieces fill their union, and a warning is given. Also warns if the pieces cannot be
/// written. Throws Error if no pieces that fill the mesh are found, or if the cut is stopped.
Pieces convex_pieces(const ClosedMesh& mesh, const MeshName& name, Diagnostics& diagnostics,
                     const std::stop_token& stop = {});

/// Name of the file that stores the pieces of a mesh.
std::string pieces_file(const std::string& mesh_file);
/// Writes pieces to a file. Throws Error if the file cannot be written.
void write_pieces(const Pieces& pieces, const std::string& file);

}  // namespace dihaptic::scene
