// Reads triangle meshes from files. The files are read by a separate program, dihaptic-mesh
// (docs/adr/0010). A damaged file can therefore crash only that program, in which case read_mesh()
// throws an Error.
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/geometry.h"

namespace dihaptic::scene {

/// A mesh of triangles, whose vertices are counter-clockwise seen from outside.
struct Mesh {
    std::vector<Vec3> vertices;           ///< [m]
    std::vector<std::vector<int>> faces;  ///< indices of the three vertices of each face
    /// Colour of each vertex in the format of scene/colour.h, -1 for a vertex without a colour;
    /// empty if no vertex has a colour.
    std::vector<int32_t> colours;
    /// For OBJ: the file from which the colours were read or, if the mesh has no colours, the file
    /// that it names for them; "" if there is none.
    std::string materials;
    std::string checksum;            ///< checksum of the mesh file as it was read (base/checksum.h)
    std::string materials_checksum;  ///< checksum of the materials file; "" if it was not read
};

/// Reads a mesh from an OBJ, STL, PLY or OFF file whose coordinates are in units of `unit` metres.
/// Also reads its colours: those of its vertices or, for vertices without a colour, those of an OBJ
/// file's materials. `asked_at` is the place where the file is named, for messages. Throws Error if
/// the file cannot be read, contains no triangle, or takes more time or memory than an intact mesh
/// of its size, or if reading is stopped. A materials file that cannot be read gives no colours.
Mesh read_mesh(const std::string& file, double unit, const Place& asked_at,
               const std::stop_token& stop = {});

/// Whether the unit of a mesh, given at `place`, could be read. Without a unit, the mesh is not
/// examined, because its size and weight would be reported as further mistakes.
bool is_unit_known(const Place& place, const Diagnostics& diagnostics);

}  // namespace dihaptic::scene
