// Reads the colours of an OBJ mesh's materials from the MTL file that the mesh names. The program
// that reads meshes (mesh.h) does not read it, because materials would change its order of
// vertices.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace dihaptic::scene {

/// Path of the MTL file that the OBJ mesh in `file` names (`text` is the mesh's content); "" if it
/// names none. The file is in the mesh's folder, under the name in the mesh or, as in sessions,
/// under the mesh's own name.
std::string materials_of(const std::string& file, std::string_view text);
/// The name for a copy of an MTL file next to the copy of its mesh.
std::string materials_beside(const std::string& file);

struct Materials {
    std::map<std::string, int32_t> colours;  ///< diffuse (Kd), by name, as in scene/colour.h
    std::string checksum;                    ///< checksum of the file as it was read
};

/// Returns no colours and no checksum if the file cannot be read.
Materials read_materials(const std::string& file);

}  // namespace dihaptic::scene
