#include "scene/look.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "base/installed.h"
#include "base/regular_file.h"
#include "scene/scene.h"

namespace dihaptic::scene {
namespace {

/// Pictures indexed by file.
using Pictures = std::map<std::string, std::shared_ptr<const Image>>;

/// The largest extent of a mesh along any axis [m].
double extent_of(const Mesh& mesh) {
    Bounds box{mesh.vertices.front(), mesh.vertices.front()};
    for (const Vec3& v : mesh.vertices) {
        box.low = box.low.cwiseMin(v);
        box.high = box.high.cwiseMax(v);
    }
    return (box.high - box.low).maxCoeff();
}

/// Checks that the seen shape and the felt shape have similar sizes; if they do not, a unit is
/// probably wrong.
void check_size(double seen, double felt, const SeenMesh& mesh, Diagnostics& diagnostics) {
    if (felt <= 0 || (seen < 2 * felt && felt < 2 * seen)) return;
    diagnostics.warning(
        mesh.place, "unit",
        fmt::format("the mesh {} measures {:g} mm, but the felt shape measures {:g} mm", mesh.file,
                    1e3 * seen, 1e3 * felt),
        "Check the unit of its coordinates.");
}

void load_seen(Body& body, const std::string& file, Diagnostics& diagnostics,
               const std::stop_token& stop) {
    SeenMesh& seen = *body.seen;
    Mesh mesh = read_mesh(file, metres(seen.unit), seen.place, stop);
    const double size = extent_of(mesh);
    if (size < kSmallest || size > kLargest)
        throw Error(seen.place, "unit", fmt::format("the mesh {} measures {:g} m", file, size),
                    "Give the unit of its coordinates: m, cm, mm or inch.");
    check_size(size, extent(body.shape), seen, diagnostics);
    if (has_own_colours(body)) {
        check_materials(mesh, file, seen.place, diagnostics);
    } else {
        mesh.colours.clear();
    }
    seen.mesh = std::make_shared<const Mesh>(std::move(mesh));
}

void load_look(Body& body, const std::string& folder, Pictures& pictures, Diagnostics& diagnostics,
               const std::stop_token& stop) {
    const auto path = [&](const std::string& file) { return named_in(folder, file); };
    const auto attempt = [&](const auto& load) {
        try {
            load();
        } catch (const Error& e) {
            diagnostics.add(e.problems());
        }
    };
    if (body.picture && !body.colour.empty())
        diagnostics.error(body.picture->place, "picture", "cannot be combined with a colour",
                          "Leave out one of the two.");
    if (body.picture && !body.picture->file.empty()) {
        attempt([&] {
            const std::string file = path(body.picture->file);
            std::shared_ptr<const Image>& image = pictures[file];
            if (!image)
                image = std::make_shared<const Image>(
                    read_picture(file, 1, Picture::kMostPixels, body.picture->place));
            body.picture->image = image;
        });
    }
    if (body.seen && !body.seen->file.empty() && is_unit_known(body.seen->unit_place, diagnostics))
        attempt([&] { load_seen(body, path(body.seen->file), diagnostics, stop); });
}

}  // namespace

bool has_own_colours(const Body& body) {
    return body.colour.empty() && !body.picture;
}

void check_materials(const Mesh& mesh, const std::string& file, const Place& place,
                     Diagnostics& diagnostics) {
    if (mesh.materials.empty() || !mesh.colours.empty()) return;
    diagnostics.warning(
        place, "file",
        fmt::format(
            "the mesh {} takes its colours from {}, which {}", file, mesh.materials,
            is_there(mesh.materials) ? "has no colour (Kd) for its materials" : "does not exist"),
        "Put the materials file next to it, or give the body a colour.");
}

void load_looks(Scene& scene, const std::string& folder, Diagnostics& diagnostics,
                const std::stop_token& stop) {
    Pictures pictures;
    for (Body& body : scene.bodies) load_look(body, folder, pictures, diagnostics, stop);
}

}  // namespace dihaptic::scene
