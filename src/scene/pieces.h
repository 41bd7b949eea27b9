// Concave meshes as convex pieces, for contact. The pieces fill the mesh exactly; a program of its
// own, dihaptic-decompose, cuts them (docs/adr/0008), and a file beside the mesh keeps them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "scene/hull.h"
#include "scene/mesh.h"

namespace dihaptic::scene {

struct Pieces {
    std::vector<Hull> hulls;  ///< in the mesh's frame [m]
    uint64_t mesh = 0;        ///< fingerprint of the mesh that they are of, unit included
};

/// The same surface with vertices at the same place made one, facing outward. Throws Error when it
/// is not closed: then it has no inside. `asked_at` is where `file` was named, for messages.
Mesh closed(const Mesh& mesh, const std::string& file, const Place& asked_at);

/// Convex pieces of a closed mesh that was read from `file`: those kept beside it when they are of
/// this mesh and intact, else new ones, which are then kept. A folder that cannot be written to is
/// warned of. Throws Error when the mesh cannot be cut, e.g. because it intersects itself.
Pieces convex_pieces(const Mesh& mesh, const std::string& file, const Place& asked_at,
                     Diagnostics& diagnostics);

/// From any thread: a cut that is going on ends, and whoever waits for it gets an Error. Does
/// nothing when there is none.
void cancel_cut() noexcept;

/// The file beside a mesh that keeps its pieces.
std::string pieces_file(const std::string& mesh_file);
/// Keeps pieces in a file. Throws Error when it cannot be written.
void write_pieces(const Pieces& pieces, const std::string& file);

}  // namespace dihaptic::scene
