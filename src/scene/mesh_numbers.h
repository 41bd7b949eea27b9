// Coordinates in mesh files. The reader of meshes takes of a word what it knows as a number and
// leaves out the rest (1.5D+01 is 1.5 to it), and keeps seven digits.
#pragma once

#include <array>
#include <string>

namespace dihaptic::scene {

struct MeshNumbers {
    std::string fault;             ///< what is wrong with the file, after its name; "": nothing
    std::array<double, 3> from{};  ///< where the origin of the coordinates is now
};

/// Looks at all coordinates of a text, or those of a binary PLY file that have double precision,
/// and counts them from the mesh's middle where seven digits would not do for them: far away from
/// the origin. `format`: obj, stl (of text), ply or off.
MeshNumbers look_at_numbers(std::string& bytes, const std::string& format);

}  // namespace dihaptic::scene
