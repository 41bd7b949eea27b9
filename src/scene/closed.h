// Turns real-world meshes into solids. Files often give each triangle its own corners, rounded
// separately; close gaps between differently subdivided faces with triangles without area; end
// edges in the middle of others; or contain overlapping parts. Meshes that can be felt as drawn are
// mended here; all others are refused.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "scene/mesh.h"

namespace dihaptic::scene {

/// Volumes and extents count as equal if they differ by less than this, relative to the larger.
constexpr double kSameSize = 1e-6;
inline bool is_same_size(double a, double b) {
    return std::abs(a - b) <= kSameSize * std::max(std::abs(a), std::abs(b));
}

/// The names by which messages refer to a mesh.
struct MeshName {
    std::string file;
    Place asked_at;         ///< where the file's name was written
    double unit = 1;        ///< unit of the file's coordinates [m]
    std::string_view word;  ///< the unit's name

    /// A point of the mesh, in the file's unit.
    std::string place(const Vec3& point) const;
    std::string volume(double cubic_metres) const;
    Error refused(const std::string& why, const std::string& remedy) const;
};

/// Connected faces of a mesh.
struct Shell {
    std::vector<size_t> faces;
    int within = -1;  ///< for a cavity: the shell out of which it is cut
};

/// A mesh each of whose edges joins two faces, and whose faces face away from the solid.
struct ClosedMesh {
    Mesh mesh;
    std::vector<Shell> shells;
};

/// The mesh with vertices at equal positions merged and all faces facing outward; in cavities,
/// which are shells within others that face inward, the faces face into the cavity. A surface that
/// is not closed is mended if it suffices to merge corners closer than a millionth of the mesh, or
/// than single precision can resolve. A warning reports this, and also shells that are turned
/// around. Throws Error if the surface remains open and so has no inside.
ClosedMesh closed(const Mesh& mesh, const MeshName& name, Diagnostics& diagnostics);

}  // namespace dihaptic::scene
