// Makes solids of meshes as they are found. Files often give each triangle its own corners, each
// rounded for itself; close the gap between faces of different subdivision by triangles without
// area; end edges in the middle of others; or draw parts that run into each other. What can be felt
// as it is drawn is mended here, and what cannot is refused.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "scene/mesh.h"

namespace dihaptic::scene {

/// Volumes and extents that differ by less are the same, relative to the larger.
constexpr double kSameSize = 1e-6;
inline bool is_same_size(double a, double b) {
    return std::abs(a - b) <= kSameSize * std::max(std::abs(a), std::abs(b));
}

/// How messages name a mesh.
struct MeshName {
    std::string file;
    Place asked_at;         ///< where the file was named
    double unit = 1;        ///< of the file's coordinates [m]
    std::string_view word;  ///< the unit's name

    /// A place in the mesh, in the file's unit.
    std::string place(const Vec3& point) const;
    std::string volume(double cubic_metres) const;
    Error refused(const std::string& why, const std::string& remedy) const;
};

/// Connected faces of a mesh.
struct Shell {
    std::vector<size_t> faces;
    int within = -1;  ///< of a cavity: the shell that it is cut out of
};

/// A mesh each of whose edges joins two faces, and whose faces face away from the solid.
struct ClosedMesh {
    Mesh mesh;
    std::vector<Shell> shells;
};

/// The mesh with vertices at equal positions merged and all faces facing outward; in cavities,
/// which are shells within others that face inward, they face into the cavity. A surface that is
/// not closed is mended if corners closer to each other than a millionth of the mesh, or than
/// single precision tells, are taken as one; this is told in a warning. So is a shell that is
/// turned around. Throws Error when the surface stays open, as it then has no inside.
ClosedMesh closed(const Mesh& mesh, const MeshName& name, Diagnostics& diagnostics);

}  // namespace dihaptic::scene
