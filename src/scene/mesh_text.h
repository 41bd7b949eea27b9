// Cleans up mesh files as they occur in practice: with byte order marks, old line ends, capitals,
// comments behind numbers, spare bytes, or without a count. The reader of meshes handles none of
// these, and does not report them.
#pragma once

#include <array>
#include <string>

namespace dihaptic::scene {

struct MeshText {
    std::string bytes;  ///< as the reader knows them
    std::string fault;  ///< what is wrong with the file, after its name; "": nothing that is seen
    std::array<double, 3> from{};  ///< where the origin of their coordinates is in the file's
};

/// `format`: obj, stl, ply or off.
MeshText tidy(std::string bytes, const std::string& format);

}  // namespace dihaptic::scene
