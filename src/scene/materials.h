// Reads the colours of an OBJ mesh's materials from the MTL file that the mesh names. The program
// that reads meshes (mesh.h) does not read the MTL file, because materials would change the order
// of the vertices.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace dihaptic::scene {

/// Path of the MTL file that is named in the OBJ mesh `file`, whose content is `text`; "" if it
/// names none. The MTL file is in the mesh's folder, either under the name given in the mesh or, as
/// in sessions, under the mesh's own name.
std::string materials_of(const std::string& file, std::string_view text);
/// The name for a copy of an MTL file next to the copy of its mesh.
std::string materials_beside(const std::string& file);

struct Materials {
    /// Diffuse colour (Kd) of each material, indexed by name, in the format of scene/colour.h.
    std::map<std::string, int32_t> colours;
    std::string checksum;  ///< checksum of the file as it was read
};

/// Reads an MTL file. Returns no colours and no checksum if the file cannot be read.
Materials read_materials(const std::string& file);

}  // namespace dihaptic::scene
