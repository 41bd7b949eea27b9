// Describes how a body looks, apart from its shape and colour. This has no effect on how the body
// feels.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "base/diagnostics.h"
#include "base/field.h"
#include "scene/picture.h"
#include "scene/shape.h"

namespace dihaptic::scene {

/// How a surface reflects light: like plastic, not at all, or like metal in the surface's colour.
enum class Finish { satin, matt, metal };
constexpr auto enum_names(Finish) {
    return std::array{"satin", "matt", "metal"};
}

/// A mesh drawn in place of a body's shape.
struct SeenMesh {
    std::string file;  ///< an OBJ, STL, PLY or OFF file, relative to the scene file
    MeshUnit unit = MeshUnit::m;
    std::shared_ptr<const Mesh> mesh;  ///< the mesh itself, without colours if others are drawn
    Place place;                       ///< where the scene file gives the mesh file
    Place unit_place;                  ///< where the scene file gives the mesh's unit

    template <class Visitor>
    void visit(Visitor& v) {
        v("file", file,
          Field::text().required().says(
              "Mesh file (OBJ, STL, PLY or OFF), relative to this file; its coordinates are in the "
              "body's frame."));
        v("unit", unit, Field::text().required().says("Unit of the mesh's coordinates."));
        if constexpr (requires { v.place(); }) {
            place = v.place_of("file");
            unit_place = v.place_of("unit");
        }
    }
};

struct Body;
struct Scene;

/// Whether the mesh is drawn in its own colours, because the body has no other colour.
bool has_own_colours(const Body& body);

/// Warns if a mesh has no colours although it names a materials file.
void check_materials(const Mesh& mesh, const std::string& file, const Place& place,
                     Diagnostics& diagnostics);

/// Reads the pictures and meshes with which bodies are drawn, until `stop` is requested. File names
/// are relative to `folder`.
void load_looks(Scene& scene, const std::string& folder, Diagnostics& diagnostics,
                const std::stop_token& stop);

}  // namespace dihaptic::scene
