// Reads triangle meshes from files. A separate program, dihaptic-mesh, does the reading
// (docs/adr/0010): a damaged file can then crash only that program, and read_mesh() throws an
// Error.
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/geometry.h"

namespace dihaptic::scene {

/// Triangles, counter-clockwise seen from outside.
struct Mesh {
    std::vector<Vec3> vertices;           ///< [m]
    std::vector<std::vector<int>> faces;  ///< three vertices each
    /// Colour of each vertex as in scene/colour.h, -1 if it has none; empty if no vertex has one.
    std::vector<int32_t> colours;
    /// OBJ: the file that gave colours or, if the mesh has no colours, the file that it names for
    /// them; "": none.
    std::string materials;
    std::string checksum;            ///< checksum of the file as it was read (base/checksum.h)
    std::string materials_checksum;  ///< checksum of its materials file; "" if that was not read
};

/// Reads a mesh from an OBJ, STL, PLY or OFF file whose coordinates are in units of `unit` metres,
/// and its colours: those of its vertices or, for vertices without, those of an OBJ file's
/// materials. `asked_at` is the position of the file's name, for messages. Throws Error when the
/// file cannot be read, contains no triangle, takes more time or memory than an intact mesh of its
/// size, or is stopped; a materials file that cannot be read gives no colours.
Mesh read_mesh(const std::string& file, double unit, const Place& asked_at,
               const std::stop_token& stop = {});

/// Whether the unit of a mesh, which was given at `place`, could be read. Without a unit the mesh
/// is not examined: its size and weight would be reported as further mistakes.
bool is_unit_known(const Place& place, const Diagnostics& diagnostics);

}  // namespace dihaptic::scene
