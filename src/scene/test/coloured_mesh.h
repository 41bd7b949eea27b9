// Meshes that have their own colours, for use in tests.
#pragma once

#include <fmt/format.h>

#include <string>

namespace dihaptic::scene {

/// A tetrahedron with an edge of 20 mm along each axis and a colour at each vertex.
inline std::string tetrahedron_ply() {
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
           "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
           "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0 255 0 0\n20 0 0 0 255 0\n0 20 0 0 0 255\n0 0 20 18 52 86\n"
           "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
}

/// The same tetrahedron as an OFF file, with colours in the form that this format uses.
inline std::string tetrahedron_off(bool whole) {
    const char* const colours[] = {
        whole ? "255 0 0 255" : "1.0 0 0 1.0", whole ? "0 255 0 255" : "0 1.0 0 1.0",
        whole ? "0 0 255 255" : "0 0 1.0 1.0", whole ? "18 52 86 255" : "0.0706 0.2039 0.3373 1.0"};
    return fmt::format(
        "COFF\n4 4 0\n0 0 0 {}\n20 0 0 {}\n0 20 0 {}\n0 0 20 {}\n3 0 2 1\n3 0 1 3\n3 0 3 2\n"
        "3 1 2 3\n",
        colours[0], colours[1], colours[2], colours[3]);
}

/// The same tetrahedron as an OBJ file with two materials: one for the faces that contain the
/// vertex at z = 20, and one for the remaining face.
inline std::string tetrahedron_obj(const std::string& library) {
    return library +
           "v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\nusemtl old oak\nf 1 3 2\nusemtl steel\n"
           "f 1 2 4\nf 1 4 3\nf 2 3 4\n";
}

inline constexpr const char* kMaterials =
    "# made by hand\r\nnewmtl steel\r\n  Ns 10\r\n  Kd 0.0 0.2 1.5\r\n\nnewmtl old oak\nKd 0.4 "
    "0.2 0.2\nnewmtl spectral\nKd spectral file.rfl 1\n";

}  // namespace dihaptic::scene
