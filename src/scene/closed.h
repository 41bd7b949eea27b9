// Turns real-world meshes into solids. In many files, each triangle has its own, separately rounded
// corners; gaps between differently subdivided faces are closed with triangles that have no area;
// edges end in the middle of other edges; or parts overlap. Meshes that can be felt as they are
// drawn are mended here; all others are refused.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "scene/mesh.h"

namespace dihaptic::scene {

/// Volumes and extents count as equal if they differ by no more than this fraction of the larger
/// one.
constexpr double kSameSize = 1e-6;
inline bool is_same_size(double a, double b) {
    return std::abs(a - b) <= kSameSize * std::max(std::abs(a), std::abs(b));
}

/// How messages refer to a mesh and to places on it.
struct MeshName {
    std::string file;
    Place asked_at;         ///< where the name of the file was written
    double unit = 1;        ///< unit of the file's coordinates [m]
    std::string_view word;  ///< name of the unit

    /// Describes a point on the mesh in words, in the unit of the file.
    std::string place(const Vec3& point) const;
    std::string volume(double cubic_metres) const;
    Error refused(const std::string& why, const std::string& remedy) const;
};

/// A set of connected faces of a mesh.
struct Shell {
    std::vector<size_t> faces;
    int within = -1;  ///< for a cavity: index of the shell from which it is cut out
};

/// A mesh in which each edge joins two faces, and all faces point away from the solid.
struct ClosedMesh {
    Mesh mesh;
    std::vector<Shell> shells;
};

/// Returns the mesh with vertices at equal positions merged and all faces pointing outward. The
/// faces of cavities, which are inward-facing shells within other shells, point into the cavity. An
/// open surface is mended if this only requires merging corners that are closer than a millionth of
/// the mesh's size, or closer than single precision can resolve. This is reported by a warning, and
/// so are shells that are reversed. Throws Error if the surface remains open and therefore has no
/// inside.
ClosedMesh closed(const Mesh& mesh, const MeshName& name, Diagnostics& diagnostics);

}  // namespace dihaptic::scene
