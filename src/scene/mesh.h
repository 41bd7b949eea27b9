// Reads triangle meshes from files. A separate program, dihaptic-mesh, does the reading
// (docs/adr/0010): a damaged file may crash it, which ends in an Error here.
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
    /// Of each vertex, as in scene/colour.h, -1 where there is none; empty if no vertex has one.
    std::vector<int32_t> colours;
    /// OBJ: the file that its colours are from or, if it has none, that it names for them; "":
    /// none.
    std::string materials;
    std::string checksum;            ///< of the file, as it was read (base/checksum.h)
    std::string materials_checksum;  ///< of the file of its colours; empty if it was not read
};

/// Reads a mesh from an OBJ, STL, PLY or OFF file whose coordinates are in units of `unit` metres,
/// and its colours: those of its vertices or, where these have none, of an OBJ file's materials.
/// `asked_at` is where the file was named, for messages. Throws Error when the file cannot be read,
/// holds no triangle, takes more time or memory than good meshes of its size do, or is stopped; a
/// file of materials that cannot be read gives no colours.
Mesh read_mesh(const std::string& file, double unit, const Place& asked_at,
               const std::stop_token& stop = {});

/// Whether the unit of a mesh, which was named at `place`, could be read. Without a unit the mesh
/// is not examined: its size and weight would be reported as further mistakes.
bool is_unit_known(const Place& place, const Diagnostics& diagnostics);

}  // namespace dihaptic::scene
