// Cuts concave meshes into convex pieces, for contact. The pieces fill the mesh exactly, which is
// checked by their volume and extent. A separate program, dihaptic-decompose, cuts the mesh
// (docs/adr/0008), and a file stores the pieces.
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
    std::vector<Hull> hulls;  ///< pieces in the mesh's frame [m]
    uint64_t mesh = 0;        ///< fingerprint of the mesh that was cut, in metres
};

/// Integrals over all pieces, for unit density.
VolumeIntegrals integrate(const Pieces& pieces);

/// Convex pieces of a closed mesh. Stored pieces are used if they are intact,
/// belong to this mesh and fill it; otherwise the mesh is cut and the new pieces are stored. If
/// shells overlap, the pieces fill their union, with a warning. Warns if the pieces cannot be
/// written. Throws Error when no pieces that fill the mesh are found, or when the cut is stopped.
Pieces convex_pieces(const ClosedMesh& mesh, const MeshName& name, Diagnostics& diagnostics,
                     const std::stop_token& stop = {});

/// Name of the file that stores a mesh's pieces.
std::string pieces_file(const std::string& mesh_file);
/// Writes pieces to a file. Throws Error when the file cannot be written.
void write_pieces(const Pieces& pieces, const std::string& file);

}  // namespace dihaptic::scene
