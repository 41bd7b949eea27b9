#include "scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "base/choices.h"
#include "base/installed.h"
#include "scene/body_checks.h"
#include "scene/closed.h"
#include "scene/colour.h"
#include "scene/finger_set.h"
#include "scene/joint_checks.h"
#include "scene/mesh.h"
#include "scene/name_checks.h"
#include "scene/names.h"
#include "scene/relief_picture.h"

namespace dihaptic::scene {
namespace {

std::vector<Finger> default_fingers() {
    // the default fingers are pads of 20 x 20 x 5 mm whose faces point along x
    Finger thumb;
    thumb.name = "thumb";
    thumb.shape = Shape::box({0.005, 0.020, 0.020});
    Finger index = thumb;
    index.name = "index";
    return {thumb, index};
}

void keep_colours(Shape& shape, const Mesh& mesh, const std::string& file,
                  Diagnostics& diagnostics) {
    check_materials(mesh, file, shape.file_place, diagnostics);
    if (!mesh.colours.empty()) shape.coloured = std::make_shared<const Mesh>(mesh);
}

/// The meshes of a scene. Each mesh is read only once, however many bodies use it.
class Meshes {
  public:
    Meshes(std::string folder, Diagnostics& diagnostics, const std::stop_token& stop)
        : folder_(std::move(folder)), diagnostics_(diagnostics), stop_(stop) {}

    /// Loads the mesh of a shape; `coloured` says whether the mesh's own colours are drawn.
    void load(Shape& shape, bool coloured);

  private:
    /// Returns null if the mesh could not be read, and reports this.
    const Mesh* read(const std::string& file, double unit, const Place& place);
    void load_file(Shape& shape, bool coloured, const std::string& file);

    const std::string folder_;
    Diagnostics& diagnostics_;
    const std::stop_token& stop_;
    std::map<std::pair<std::string, double>, std::optional<Mesh>> known_;
};

const Mesh* Meshes::read(const std::string& file, double unit, const Place& place) {
    const auto [known, is_new] = known_.try_emplace({file, unit});
    if (is_new) known->second = read_mesh(file, unit, place, stop_);
    return known->second ? &*known->second : nullptr;
}

void Meshes::load(Shape& shape, bool coloured) {
    for (Part& part : shape.parts) load(part.shape, coloured);
    if (shape.kind != ShapeKind::mesh || shape.file.empty() ||
        !is_unit_known(shape.unit_place, diagnostics_))
        return;
    try {
        load_file(shape, coloured, named_in(folder_, shape.file));
    } catch (const Error& e) {
        diagnostics_.add(e.problems());
    }
}

void Meshes::load_file(Shape& shape, bool coloured, const std::string& file) {
    const Place& place = shape.file_place;
    const Mesh* const found = read(file, metres(shape.unit), place);
    if (found == nullptr) return;
    const Mesh& mesh = *found;
    shape.checksum = mesh.checksum;
    shape.hull = convex_hull(mesh.vertices);
    if (shape.hull.faces.empty()) {
        diagnostics_.error(
            place, "file",
            "the mesh " + file + " encloses no volume: its vertices lie in a plane or on a line",
            "Give it some thickness.");
        return;
    }
    if (const double size = extent(shape); size < kSmallest || size > kLargest) {
        diagnostics_.error(place, "unit", fmt::format("the mesh {} measures {:g} m", file, size),
                           "Give the unit of its coordinates: m, cm, mm or inch.");
        return;
    }
    if (coloured) keep_colours(shape, mesh, file, diagnostics_);
    if (shape.concave) {
        const MeshName name{file, place, metres(shape.unit), enum_name(shape.unit)};
        ClosedMesh solid = closed(mesh, name, diagnostics_);
        shape.pieces = convex_pieces(solid, name, diagnostics_, stop_);
        // where shells overlap, the volume counts only once
        const VolumeIntegrals shells = integrate(solid.mesh.vertices, solid.mesh.faces);
        const VolumeIntegrals pieces = integrate(shape.pieces);
        shape.solid = is_same_size(shells.volume, pieces.volume) ? shells : pieces;
        shape.surface = std::move(solid.mesh);
        return;
    }
    const double solid = integrate(mesh.vertices, mesh.faces).volume;
    const double hull = integrate(shape.hull.vertices, shape.hull.faces).volume;
    if (solid > 0 && solid < 0.98 * hull) {
        diagnostics_.warning(
            place, "file",
            fmt::format("the mesh {} is not convex: its convex hull, of {:.0f} % more volume, "
                        "replaces it",
                        file, 100 * (hull / solid - 1)),
            "Add concave: yes to make the mesh itself felt.");
    }
}

void load_relief(Surface& surface, const std::string& folder, Diagnostics& diagnostics) {
    if (!surface.texture || surface.texture->file.empty()) return;
    const std::string file = named_in(folder, surface.texture->file);
    try {
        surface.texture->picture =
            std::make_shared<const ReliefPicture>(read_relief(file, surface.texture->place));
    } catch (const Error& e) {
        diagnostics.add(e.problems());
    }
}

/// If there are more than `most` objects, reports this, removes the excess and returns false.
template <class Thing>
bool check_count(std::vector<Thing>& things, size_t most, const char* key,
                 Diagnostics& diagnostics) {
    if (things.size() <= most) return true;
    diagnostics.error(things[most].place, key,
                      fmt::format("there are {}, but at most {} are allowed", things.size(), most),
                      "Leave out those from here on, or split the scene.");
    things.resize(most);
    return false;
}

bool check_counts(Scene& scene, Diagnostics& diagnostics) {
    bool out = check_count(scene.bodies, kMostThings, "bodies", diagnostics);
    out &= check_count(scene.joints, kMostThings, "joints", diagnostics);
    out &= check_count(scene.pairs, kMostThings, "pairs", diagnostics);
    out &= check_count(scene.lattices, kMostLattices, "lattices", diagnostics);
    out &= check_count(scene.fingers, kMostFingers, "fingers", diagnostics);
    return out;
}

/// Converts the joints that are given in a body's frame to the world frame.
void place_joints(Scene& scene, Diagnostics& diagnostics) {
    for (Joint& joint : scene.joints) {
        if (joint.in.empty()) continue;
        const int index = scene.find(joint.in);
        if (index < 0) {
            report_unknown_body(joint.in, scene, joint.place, "in", diagnostics);
            continue;
        }
        const Pose X_WB = scene.bodies[static_cast<size_t>(index)].pose();
        joint.position = X_WB * joint.position;
        if (joint.second_position) joint.second_position = X_WB * *joint.second_position;
        joint.axis = X_WB.R * joint.axis;
        joint.second_axis = X_WB.R * joint.second_axis;
        joint.rotation = angles_xyz(X_WB.R * rotation_xyz(joint.rotation));
        joint.in.clear();
    }
}

}  // namespace

void report_unknown_body(const std::string& name, const Scene& scene, const Place& place,
                         const char* key, Diagnostics& diagnostics) {
    std::vector<std::string> bodies;
    for (const Body& body : scene.bodies) bodies.push_back(body.name);
    diagnostics.error(place, key, fmt::format("there is no body '{}'", name),
                      meant(name, bodies, diagnostics, "There are"), choices_of(bodies));
}

int Scene::find(const std::string& name) const {
    for (size_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i].name == name) return static_cast<int>(i);
    }
    return -1;
}

int Scene::object_index() const {
    if (!object.empty()) return find(object);
    for (size_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i].moves_at_all()) return static_cast<int>(i);
    }
    return -1;
}

std::vector<std::string> finger_names(const Scene& scene) {
    std::vector<std::string> names;
    for (const Finger& finger : scene.fingers) names.push_back(finger.name);
    return names;
}

const Pair* find_pair(const Scene& scene, const std::string& a, const std::string& b) {
    for (const Pair& pair : scene.pairs) {
        if (pair.between.size() != 2) continue;
        const std::string& first = pair.between[0];
        const std::string& second = pair.between[1];
        if ((first == a && second == b) || (first == b && second == a)) return &pair;
    }
    return nullptr;
}

double pair_friction(const Scene& scene, const std::string& a, double friction_a,
                     const std::string& b, double friction_b) {
    const Pair* pair = find_pair(scene, a, b);
    return pair != nullptr && pair->friction ? *pair->friction : std::sqrt(friction_a * friction_b);
}

double mass(const Body& body) {
    return body.mass ? *body.mass : body.density.value_or(0) * integrate(body.shape).volume;
}

std::span<const Joint> recorded_joints(const Scene& scene) {
    const auto end = std::find_if_not(scene.joints.begin(), scene.joints.end(),
                                      [](const Joint& joint) { return joint.recorded; });
    return {scene.joints.begin(), end};
}

bool flies(const Scene& scene, const Body& body) {
    const auto holds = [&](const Joint& joint) {
        return std::find(joint.between.begin(), joint.between.end(), body.name) !=
               joint.between.end();
    };
    return body.moves_at_all() && body.moves == Axes::xyz &&
           std::none_of(scene.joints.begin(), scene.joints.end(), holds);
}

void complete(Scene& scene, const std::string& folder, Diagnostics& diagnostics,
              const std::stop_token& stop) {
    if (scene.fingers.empty()) scene.fingers = default_fingers();
    if (!check_counts(scene, diagnostics)) return;
    place_joints(scene, diagnostics);
    expand_lattices(scene, diagnostics);
    if (!check_counts(scene, diagnostics)) return;
    std::stable_partition(scene.joints.begin(), scene.joints.end(),
                          [](const Joint& joint) { return joint.recorded; });
    Meshes meshes(folder, diagnostics, stop);
    for (Body& body : scene.bodies) {
        meshes.load(body.shape, has_own_colours(body) && !body.seen);
        load_relief(body.surface, folder, diagnostics);
        check_parts(body.shape, body.place, diagnostics);
        check_body(body, diagnostics);
    }
    load_looks(scene, folder, diagnostics, stop);
    for (Finger& finger : scene.fingers) {
        meshes.load(finger.shape, false);
        check_parts(finger.shape, finger.place, diagnostics);
        check_plausible(finger.shape, finger.place, diagnostics);
        if (finger.shape.kind == ShapeKind::plane) {
            diagnostics.error(finger.place, "shape", "a finger cannot be a plane",
                              "Use a box, a sphere or a mesh.");
        }
    }
    if (scene.bodies.empty() && !scene.bodies_place.file.empty() && !diagnostics.has_errors()) {
        diagnostics.error(scene.bodies_place, "bodies", "there are none",
                          "List at least one body.");
    }
    check_names(scene, diagnostics);
    check_references(scene, diagnostics);
    check_surfaces(scene, diagnostics);
    check_joints(scene, diagnostics);
    if (diagnostics.has_errors()) return;
    check_softness(scene, diagnostics);
    check_overlaps(scene, diagnostics);
}

Scene read_scene(const std::string& file, Diagnostics& diagnostics, const std::stop_token& stop) {
    Scene scene;
    try {
        read_fields(scene, read_yaml(file), diagnostics);
    } catch (const Error& e) {
        diagnostics.add(e.problems());
        return scene;
    }
    complete(scene, std::filesystem::path(file).parent_path().string(), diagnostics, stop);
    return scene;
}

}  // namespace dihaptic::scene
