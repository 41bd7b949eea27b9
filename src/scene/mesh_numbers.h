// Checks the coordinates in mesh files. The mesh reader uses the part of a word that it
// recognises as a number and ignores the rest (it reads 1.5D+01 as 1.5), and it keeps seven digits.
#pragma once

#include <array>
#include <string>

namespace dihaptic::scene {

struct MeshNumbers {
    std::string fault;             ///< the file's fault, to follow its name; "": none
    std::array<double, 3> from{};  ///< the new origin of the coordinates
};

/// Checks all coordinates of a text, or those of a binary PLY file in double precision. If seven
/// digits do not suffice, far from the origin, it subtracts the mesh's centre from them.
/// `format`: obj, stl (text), ply or off.
MeshNumbers look_at_numbers(std::string& bytes, const std::string& format);

}  // namespace dihaptic::scene
