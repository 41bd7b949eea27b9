// Cleans up real-world mesh files, with byte order marks, old line ends, capitals, comments after
// numbers, spare bytes, or no count. The mesh reader handles none of these, and does not report
// them.
#pragma once

#include <array>
#include <string>

namespace dihaptic::scene {

struct MeshText {
    std::string bytes;             ///< in the form that the reader expects
    std::string fault;             ///< the file's fault, to follow its name; "": none detected
    std::array<double, 3> from{};  ///< position of the new origin in the file's coordinates
};

/// `format`: obj, stl, ply or off.
MeshText tidy(std::string bytes, const std::string& format);

}  // namespace dihaptic::scene
