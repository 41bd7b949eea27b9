// Checks the coordinates in mesh files. The reader of meshes uses the part of a word that it
// recognises as a number and ignores the rest (it reads 1.5D+01 as 1.5), and it keeps seven digits.
#pragma once

#include <array>
#include <string>

namespace dihaptic::scene {

struct MeshNumbers {
    std::string fault;             ///< what is wrong with the file, after its name; "": nothing
    std::array<double, 3> from{};  ///< where the origin of the coordinates is now
};

/// Checks all coordinates of a text, or those of a binary PLY file in double precision. Where seven
/// digits would not suffice, far away from the origin, it subtracts the mesh's middle from them.
/// `format`: obj, stl (of text), ply or off.
MeshNumbers look_at_numbers(std::string& bytes, const std::string& format);

}  // namespace dihaptic::scene
