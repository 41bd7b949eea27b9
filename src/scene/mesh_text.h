// Cleans up real-world mesh files, which may have byte order marks, old line endings, capitals,
// comments after numbers or spare bytes, or may lack a count. The mesh reader neither handles nor
// reports any of these.
#pragma once

#include <array>
#include <string>

namespace dihaptic::scene {

struct MeshText {
    std::string bytes;             ///< the file's content in the form that the reader expects
    std::string fault;             ///< fault, worded to follow the file's name; "" if none
    std::array<double, 3> from{};  ///< position of the new origin in the file's coordinates
};

/// Cleans up the content of a mesh file. `format` is obj, stl, ply or off.
MeshText tidy(std::string bytes, const std::string& format);

}  // namespace dihaptic::scene
