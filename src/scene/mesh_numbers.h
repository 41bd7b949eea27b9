// Checks the coordinates in mesh files. The mesh reader uses only the part of a word that it
// recognises as a number and ignores the rest (it reads 1.5D+01 as 1.5), and it keeps only seven
// digits.
#pragma once

#include <array>
#include <string>

namespace dihaptic::scene {

struct MeshNumbers {
    std::string fault;             ///< fault, worded to follow the file's name; "" if none
    std::array<double, 3> from{};  ///< the point that has become the origin of the coordinates
};

/// Checks all coordinates in a text, or those of a binary PLY file in double precision. If the mesh
/// is so far from the origin that seven digits do not suffice, subtracts the mesh's centre from all
/// coordinates. `format` is obj, stl (text), ply or off.
MeshNumbers look_at_numbers(std::string& bytes, const std::string& format);

}  // namespace dihaptic::scene
