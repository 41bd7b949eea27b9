#include "scene/scene.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "scene/mesh.h"

namespace dihaptic::scene {
namespace {

/// Larger or heavier than anything on a tabletop: almost surely a slip of the unit.
constexpr double kImplausibleSize = 3.0;   // [m]
constexpr double kImplausibleMass = 20.0;  // [kg]

double metres(MeshUnit unit) {
    switch (unit) {
        case MeshUnit::m:
            return 1;
        case MeshUnit::cm:
            return 1e-2;
        case MeshUnit::mm:
            return 1e-3;
    }
    return 1;
}

std::vector<Finger> default_fingers() {
    // pads of 20 x 20 x 5 mm whose faces look along x
    Finger thumb;
    thumb.name = "thumb";
    thumb.shape = Shape::box({0.005, 0.020, 0.020});
    Finger index = thumb;
    index.name = "index";
    return {thumb, index};
}

void load_mesh(Shape& shape, const std::string& folder, const Place& place,
               Diagnostics& diagnostics) {
    if (shape.kind != ShapeKind::mesh || shape.file.empty()) return;
    const std::string file =
        (std::filesystem::path(folder) / shape.file).lexically_normal().string();
    try {
        const Mesh mesh = read_mesh(file, metres(shape.unit), place);
        shape.hull = convex_hull(mesh.vertices);
        if (shape.hull.faces.empty()) {
            diagnostics.error(place, "file", "the mesh " + file + " is flat: it encloses no volume",
                              "Give it some thickness.");
            return;
        }
        const double solid = integrate(mesh.vertices, mesh.faces).volume;
        const double hull = integrate(shape.hull.vertices, shape.hull.faces).volume;
        if (solid > 0 && solid < 0.98 * hull) {
            diagnostics.warning(
                place, "file",
                fmt::format("the mesh {} is not convex: its convex hull, of {:.0f} % more volume, "
                            "stands in for it",
                            file, 100 * (hull / solid - 1)),
                "Fingers will feel the hull.");
        }
    } catch (const Error& e) {
        diagnostics.add(e.problems());
    }
}

void check_plausible(const Shape& shape, const Place& place, Diagnostics& diagnostics) {
    if (extent(shape) > kImplausibleSize) {
        diagnostics.warning(place, "", fmt::format("this shape is {:g} m large", extent(shape)),
                            "Check the unit of its size; a tabletop is about 1 m.");
    }
}

void check_body(const Body& body, Diagnostics& diagnostics) {
    check_plausible(body.shape, body.place, diagnostics);
    if (body.shape.kind == ShapeKind::plane && body.moves_at_all()) {
        diagnostics.error(body.place, "fixed", "a plane is infinite and cannot move",
                          "Add fixed: yes.");
    }
    if (body.mass && body.density) {
        diagnostics.error(body.place, "density", "both mass and density are given",
                          "Keep one of the two.");
    }
    if (body.fixed) return;
    if (!body.mass && !body.density) {
        diagnostics.error(body.place, body.name, "has neither mass nor density",
                          "Add mass_g or density_g_cm3, or fixed: yes.");
        return;
    }
    if (mass(body) > kImplausibleMass) {
        diagnostics.warning(body.place, body.name, fmt::format("weighs {:g} kg", mass(body)),
                            "Check the unit of its mass or density.");
    }
    const bool two_axes =
        body.turns == Axes::xy || body.turns == Axes::xz || body.turns == Axes::yz;
    if (two_axes) {
        diagnostics.error(body.place, "turns", "a body cannot be held to turn about two axes",
                          "Use none, x, y, z or xyz.");
    }
}

void check_names(const Scene& scene, Diagnostics& diagnostics) {
    std::set<std::string> names;
    const auto check = [&](const std::string& name, const Place& place) {
        if (!name.empty() && !names.insert(name).second) {
            diagnostics.error(place, "name", fmt::format("'{}' is used twice", name),
                              "Give each body and finger a name of its own.");
        }
    };
    for (const Body& body : scene.bodies) check(body.name, body.place);
    for (const Finger& finger : scene.fingers) check(finger.name, finger.place);

    const std::vector<std::string> known(names.begin(), names.end());
    const auto must_exist = [&](const std::string& name, const char* key, const Place& place) {
        if (names.contains(name)) return;
        const std::string guess = nearest(name, known);
        diagnostics.error(place, key, fmt::format("there is no body or finger '{}'", name),
                          guess.empty() ? "" : fmt::format("Did you mean {}?", guess));
    };
    for (const PairFriction& pair : scene.pairs) {
        if (pair.between.size() != 2) {
            diagnostics.error(pair.place, "between", "must be two names",
                              "Write between: [block, thumb].");
        }
        for (const std::string& name : pair.between) must_exist(name, "between", pair.place);
    }
    if (!scene.object.empty() && scene.find(scene.object) < 0)
        must_exist(scene.object, "object", {});
}

}  // namespace

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

double pair_friction(const Scene& scene, const std::string& a, double friction_a,
                     const std::string& b, double friction_b) {
    for (const PairFriction& pair : scene.pairs) {
        if (pair.between.size() != 2) continue;
        const std::string& first = pair.between[0];
        const std::string& second = pair.between[1];
        if ((first == a && second == b) || (first == b && second == a)) return pair.friction;
    }
    return std::sqrt(friction_a * friction_b);
}

double mass(const Body& body) {
    return body.mass ? *body.mass : body.density.value_or(0) * integrate(body.shape).volume;
}

void complete(Scene& scene, const std::string& folder, Diagnostics& diagnostics) {
    if (scene.fingers.empty()) scene.fingers = default_fingers();
    for (Body& body : scene.bodies) {
        load_mesh(body.shape, folder, body.place, diagnostics);
        check_body(body, diagnostics);
    }
    for (Finger& finger : scene.fingers) {
        load_mesh(finger.shape, folder, finger.place, diagnostics);
        check_plausible(finger.shape, finger.place, diagnostics);
        if (finger.shape.kind == ShapeKind::plane) {
            diagnostics.error(finger.place, "shape", "a finger cannot be a plane",
                              "Use a box, a sphere or a mesh.");
        }
    }
    check_names(scene, diagnostics);
}

Scene read_scene(const std::string& file, Diagnostics& diagnostics) {
    Scene scene;
    try {
        read_fields(scene, read_yaml(file), diagnostics);
    } catch (const Error& e) {
        diagnostics.add(e.problems());
        return scene;
    }
    complete(scene, std::filesystem::path(file).parent_path().string(), diagnostics);
    return scene;
}

}  // namespace dihaptic::scene
