#include "scene/scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "base/choices.h"
#include "base/installed.h"
#include "base/text.h"
#include "base/unit.h"
#include "scene/closed.h"
#include "scene/colour.h"
#include "scene/finger_set.h"
#include "scene/mesh.h"
#include "scene/names.h"
#include "scene/relief_picture.h"

namespace dihaptic::scene {
namespace {

/// Limits of plausible values: anything on a tabletop is smaller and lighter, so beyond these
/// limits a unit is probably wrong.
constexpr double kImplausibleSize = 3.0;      // [m]
constexpr double kImplausibleMass = 20.0;     // [kg]
constexpr double kImplausiblyLight = 1e-5;    // [kg]
constexpr double kImplausibleDistance = 3.0;  // of a body that moves, from the origin [m]
constexpr double kImplausibleTurn = 4 * std::numbers::pi;  // [rad]

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

void check_parts(const Shape& shape, const Place& place, Diagnostics& diagnostics) {
    if (shape.kind != ShapeKind::compound) return;
    if (shape.parts.empty()) {
        diagnostics.error(place, "parts", "there are none",
                          "List at least one, each with a shape.");
    }
    for (const Part& part : shape.parts) {
        if (part.shape.kind != ShapeKind::plane && part.shape.kind != ShapeKind::compound) continue;
        diagnostics.error(part.place, "shape",
                          fmt::format("a part cannot be a {}", enum_name(part.shape.kind)),
                          "Use a box, sphere, capsule, cylinder, cone or mesh.");
    }
}

/// Whether the volume integrals of the shape are known. They are unknown if its mesh could not be
/// loaded.
bool has_volume(const Shape& shape) {
    return shape.kind != ShapeKind::plane && integrate(shape).volume > 0;
}

void check_plausible(const Shape& shape, const Place& place, Diagnostics& diagnostics) {
    if (extent(shape) > kImplausibleSize) {
        diagnostics.warning(place, "", fmt::format("this shape measures {:g} m", extent(shape)),
                            "Check the unit of its size; a tabletop is about 1 m.");
    }
}

/// Checks the mass of a body that can move. Returns false if the mass is impossible.
bool check_weight(const Body& body, Diagnostics& diagnostics) {
    if (!body.mass && !body.density) {
        if (body.weighed) return false;  // the wrong key has already been reported
        diagnostics.error(body.place, body.name, "has neither mass nor density",
                          "Add mass_g or density_g_cm3, or fixed: yes.");
        return false;
    }
    if (has_volume(body.shape) && (mass(body) < kLightest || mass(body) > kHeaviest)) {
        diagnostics.error(body.place, body.name, fmt::format("weighs {:g} kg", mass(body)),
                          "Check the units of its size and its density.");
        return false;
    }
    if (mass(body) > kImplausibleMass ||
        (has_volume(body.shape) && mass(body) < kImplausiblyLight)) {
        diagnostics.warning(body.place, body.name, fmt::format("weighs {:g} kg", mass(body)),
                            "Check the unit of its mass or density.");
    }
    return true;
}

void check_driven(const Body& body, Diagnostics& diagnostics) {
    if (!body.fixed && !body.weighed) return;
    diagnostics.error(body.place, body.fixed ? "fixed" : "mass", "does not apply to a driven body",
                      "Leave it out.");
}

void check_plausible_pose(const Body& body, Diagnostics& diagnostics) {
    if (body.moves_at_all() && body.position.norm() > kImplausibleDistance) {
        diagnostics.warning(body.place, body.name,
                            fmt::format("begins {:g} m from the origin", body.position.norm()),
                            "Check the unit of its position.");
    }
    if (body.rotation.cwiseAbs().maxCoeff() > kImplausibleTurn) {
        diagnostics.warning(body.place, body.name,
                            fmt::format("is turned by {:.0f} degrees",
                                        body.rotation.cwiseAbs().maxCoeff() / kDegree),
                            "Check the unit of its rotation.");
    }
}

void check_body(const Body& body, Diagnostics& diagnostics) {
    check_plausible_pose(body, diagnostics);
    check_plausible(body.shape, body.place, diagnostics);
    read_colour(body.colour, body.place, diagnostics);
    if (body.driven) check_driven(body, diagnostics);
    if (body.shape.kind == ShapeKind::plane && (body.moves_at_all() || body.driven)) {
        diagnostics.error(body.place, "fixed", "a plane is infinite and cannot move",
                          "Add fixed: yes.");
    }
    if (body.mass && body.density) {
        diagnostics.error(body.place, "density", "both mass and density are given",
                          "Keep one of the two.");
    }
    if (body.fixed || body.driven || !check_weight(body, diagnostics)) return;
    const bool two_axes =
        body.turns == Axes::xy || body.turns == Axes::xz || body.turns == Axes::yz;
    if (two_axes) {
        diagnostics.error(body.place, "turns", "a body cannot turn about exactly two axes",
                          "Use none, x, y, z or xyz.");
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

/// Checks that no two columns have the same name: a body called "thumb_proxy" and the thumb's proxy
/// would both have a column thumb_proxy_position.
void check_columns(const Scene& scene, Diagnostics& diagnostics) {
    std::set<std::string> taken;
    for (const Finger& finger : scene.fingers) {
        taken.insert(finger.name + "_contact");
        for (const char* part : {"_device", "_handle", "_proxy"}) {
            taken.insert(finger.name + part);
            taken.insert(finger.name + part + "_angular");
        }
    }
    const auto for_each_thing = [&](const auto& act) {
        for (const Body& body : scene.bodies) act(body.name, body.place);
        for (const Joint& joint : scene.joints) act(joint.name, joint.place);
    };
    for_each_thing([&](const std::string& name, const Place&) { taken.insert(name + "_angular"); });
    for_each_thing([&](const std::string& name, const Place& place) {
        if (taken.contains(name))
            diagnostics.error(
                place, "name",
                fmt::format("'{}' is the name of another object's part in recordings", name),
                "Choose another name.");
    });
}

/// Whether a text may be a name. Names become parts of paths in the session's folder and in its NWB
/// file.
bool may_be_name(const std::string& name) {
    return !name.starts_with('.') && name.find_first_of("/\\") == std::string::npos &&
           !find_fault(name, Lines::one);
}

void check_names(const Scene& scene, Diagnostics& diagnostics) {
    // the default fingers, thumb and index, have no line in the file
    const bool in_file = !scene.fingers.empty() && !scene.fingers.front().place.file.empty();
    std::set<std::string> names;
    for (const Finger& finger : scene.fingers) {
        if (!in_file) names.insert(finger.name);
    }
    const auto check = [&](const std::string& name, const Place& place) {
        if (!may_be_name(name)) {
            diagnostics.error(place, "name", fmt::format("'{}' cannot be a name", name),
                              "Use letters, digits, blanks, '-' and '_'.");
        }
        if (name.size() > kLongestName) {
            diagnostics.error(place, "name", fmt::format("has {} bytes", name.size()),
                              fmt::format("Choose a name of at most {} bytes.", kLongestName));
        }
        if (!name.empty() && !names.insert(name).second) {
            diagnostics.error(place, "name", fmt::format("'{}' is used twice", name),
                              in_file ? "Give each body, finger and joint a name of its own."
                                      : "Give each body, finger and joint a name of its own; where "
                                        "fingers are left out, they are called thumb and index.");
        }
    };
    for (const Body& body : scene.bodies) check(body.name, body.place);
    for (const Finger& finger : scene.fingers) {
        if (in_file) check(finger.name, finger.place);
    }
    for (const Joint& joint : scene.joints) check(joint.name, joint.place);
    check_columns(scene, diagnostics);
}

void check_references(const Scene& scene, Diagnostics& diagnostics) {
    std::vector<std::string> known = finger_names(scene);
    std::vector<std::string> movable;
    for (const Body& body : scene.bodies) {
        known.push_back(body.name);
        if (body.moves_at_all()) movable.push_back(body.name);
    }
    const auto must_exist = [&](const std::string& name, const char* key, const Place& place,
                                const std::vector<std::string>& choices) {
        if (std::find(known.begin(), known.end(), name) != known.end()) return;
        diagnostics.error(place, key, fmt::format("there is no body or finger '{}'", name),
                          meant(name, known, diagnostics, "There are"), choices_of(choices));
    };
    std::set<std::pair<std::string, std::string>> pairs;
    for (const Pair& pair : scene.pairs) {
        for (const std::string& name : pair.between) must_exist(name, "between", pair.place, known);
        if (pair.between.size() != 2) {
            diagnostics.error(pair.place, "between", "must be two names",
                              "Write between: [block, thumb].");
            continue;
        }
        const auto& [a, b] = std::minmax(pair.between[0], pair.between[1]);
        if (a == b) {
            diagnostics.error(pair.place, "between", fmt::format("'{}' cannot touch itself", a),
                              "Name two different bodies or fingers.");
        } else if (!pairs.insert({a, b}).second) {
            diagnostics.error(pair.place, "between",
                              fmt::format("the pair of {} and {} is given twice", a, b),
                              "Keep one of the two.");
        }
    }
    if (scene.object.empty()) return;
    if (const int object = scene.find(scene.object); object < 0) {
        must_exist(scene.object, "object", scene.object_place, movable);
        if (std::find(known.begin(), known.end(), scene.object) != known.end()) {
            diagnostics.error(scene.object_place, "object",
                              fmt::format("'{}' is a finger", scene.object), "Name a body.");
        }
    } else if (!scene.bodies[static_cast<size_t>(object)].moves_at_all()) {
        diagnostics.error(scene.object_place, "object", fmt::format("'{}' is fixed", scene.object),
                          "Name a movable body; summaries describe this body.");
    }
}

/// Checks that the two points of a distance joint are apart.
void check_points(const Joint& joint, Diagnostics& diagnostics) {
    if (joint.is_distance() != joint.second_position.has_value()) {
        diagnostics.error(joint.place, "second_position",
                          joint.is_distance() ? "is missing" : "belongs to a distance joint",
                          joint.is_distance() ? "Give the second body's point at the start."
                                              : "Leave it out, or set kind: distance.");
    } else if (joint.is_rod() && (*joint.second_position - joint.position).norm() < 1e-9) {
        diagnostics.error(joint.place, "second_position",
                          "is the same point, so the rod has no direction",
                          "Move it, or set kind: ball.");
    }
}

/// Checks that a bushing, and no other joint, has stiffnesses or dampings for its axes.
void check_bushing(const Joint& joint, Diagnostics& diagnostics) {
    const bool bushes = !joint.stiffnesses.isZero(0) || !joint.turn_stiffnesses.isZero(0) ||
                        !joint.dampings.isZero(0) || !joint.turn_dampings.isZero(0);
    if (bushes != joint.row().yields)
        diagnostics.error(joint.place, "stiffnesses",
                          bushes ? fmt::format("belongs to a bushing joint, not to a {} joint",
                                               enum_name(joint.kind))
                                 : "is missing",
                          bushes ? "Give a single stiffness, or set kind: bushing."
                                 : "Add e.g. stiffnesses_N_m: [500, 500, 2000].");
}

/// Checks that the points of a curve are in ascending order, and that no segment is steeper than
/// the stiffest spring allowed.
void check_curve(const Joint& joint, Diagnostics& diagnostics) {
    const SpringCurve& curve = joint.curve;
    if (curve.stretch.empty() && curve.resistance.empty()) return;
    const char* const example = "Write e.g. curve_at_mm: [-10, 0, 10] and curve_N: [-2, 0, 5].";
    const size_t points = curve.stretch.size();
    if (points < 2 || points != curve.resistance.size()) {
        diagnostics.error(
            joint.place, points < 2 ? "curve_at" : "curve",
            fmt::format("has {} stretches and {} resistances, but needs two or more of "
                        "each",
                        points, curve.resistance.size()),
            example);
        return;
    }
    if (joint.stiffness > 0)
        diagnostics.error(joint.place, "stiffness",
                          "cannot be combined with a curve, which is a spring itself",
                          "Leave out one of the two.");
    for (size_t i = 1; i < points; ++i) {
        const double way = curve.stretch[i] - curve.stretch[i - 1];
        if (!(way > 0)) {
            diagnostics.error(joint.place, "curve_at", "does not ascend", example);
            return;
        }
        if (std::abs(curve.resistance[i] - curve.resistance[i - 1]) <= Joint::kStiffest * way)
            continue;
        diagnostics.error(joint.place, "curve",
                          fmt::format("has a segment steeper than {:g} {}", Joint::kStiffest,
                                      joint.slides() ? "N/m" : "N*m/rad"),
                          "Model a wall as a stop (low, high).");
    }
}

/// Checks that a joint with springs, dampers, friction or stops has a free axis to which they
/// apply.
void check_axis(const Joint& joint, Diagnostics& diagnostics) {
    const bool asks = joint.has_axis_spring() || joint.damping > 0 || joint.friction > 0 ||
                      joint.low || joint.high;
    if (asks && !joint.has_coordinate()) {
        diagnostics.error(
            joint.place, joint.name,
            fmt::format("has a spring, damper, friction or stop, but a {} joint has no "
                        "single axis for it",
                        enum_name(joint.kind)),
            joint.row().yields
                ? "Give stiffnesses and dampings for each axis."
                : fmt::format("Leave it out, or set kind: {}.",
                              kinds_that(&JointKindRow::has_coordinate, &JointKindRow::name)));
    }
    constexpr double kShort = 1e-9;
    if (joint.axis.norm() < kShort)
        diagnostics.error(joint.place, "axis", "has no direction", "Write e.g. axis: [0, 0, 1].");
    if (joint.row().turning == Turning::about_two_axes &&
        joint.axis.cross(joint.second_axis).norm() <
            kShort * joint.axis.norm() * joint.second_axis.norm())
        diagnostics.error(joint.place, "second_axis", "lies along the first axis",
                          "Set it at an angle to the first axis, ideally a right angle.");
    if (joint.low && joint.high && *joint.low > *joint.high)
        diagnostics.error(joint.place, "low", "is above 'high', so that no position is allowed",
                          "Exchange the two.");
}

/// Warns about a joint that starts beyond its stops, because this would hurl the joined bodies
/// away.
void check_start(const Joint& joint, Diagnostics& diagnostics) {
    if (!joint.has_coordinate()) return;
    double start = 0;
    if (joint.is_distance() && joint.second_position)
        start = (*joint.second_position - joint.position).norm();
    constexpr double kSlack = 1e-9;
    const bool below = joint.low && start < *joint.low - kSlack;
    if (!below && !(joint.high && start > *joint.high + kSlack)) return;
    const double unit = joint.slides() ? 1e-3 : kDegree;
    diagnostics.warning(
        joint.place, below ? "low" : "high",
        fmt::format("{} starts at {:.4g} {}, beyond its stop at {:.4g}", joint.name, start / unit,
                    joint.slides() ? "mm" : "deg", (below ? *joint.low : *joint.high) / unit),
        "Start within its stops; otherwise the first tick would hurl the joined bodies.");
}

/// Warns about joined bodies whose masses differ so much that rounding affects the motion of the
/// lighter one.
void check_masses(const Joint& joint, const Scene& scene, Diagnostics& diagnostics) {
    constexpr double kApart = 1e6;
    if (joint.between.size() != 2) return;
    double masses[2];
    for (size_t i = 0; i < 2; ++i) {
        const int body = scene.find(joint.between[i]);
        if (body < 0 || !scene.bodies[static_cast<size_t>(body)].moves_at_all()) return;
        masses[i] = mass(scene.bodies[static_cast<size_t>(body)]);
    }
    const auto [light, heavy] = std::minmax(masses[0], masses[1]);
    if (!(light > 0) || heavy < kApart * light) return;
    diagnostics.warning(
        joint.place, joint.name,
        fmt::format("joins {:.3g} kg to {:.3g} kg, a ratio above {:g}", light, heavy, kApart),
        "Check the units of their masses.");
}

void check_between(const Joint& joint, const Scene& scene, Diagnostics& diagnostics) {
    if (joint.between.empty() || joint.between.size() > 2) {
        diagnostics.error(joint.place, "between", "must contain one or two bodies",
                          "Write between: [cart, bob], or between: [door] for a joint to the "
                          "world.");
        return;
    }
    bool moves = false;
    bool known = true;
    for (const std::string& name : joint.between) {
        const int body = scene.find(name);
        known = known && body >= 0;
        moves = moves || (body >= 0 && scene.bodies[static_cast<size_t>(body)].moves_at_all());
        if (body >= 0) continue;
        report_unknown_body(name, scene, joint.place, "between", diagnostics);
    }
    if (joint.between.front() == joint.between.back() && joint.between.size() == 2) {
        diagnostics.error(joint.place, "between",
                          fmt::format("'{}' cannot be joined to itself", joint.between[0]),
                          "Name two different bodies.");
    } else if (known && !moves) {
        diagnostics.error(joint.place, "between", "joins no body that can move",
                          "Name a movable body, or leave the joint out.");
    }
}

/// The shortest edge of a body's bounding box [m].
double thickness(const Body& body) {
    const Bounds box = bounds(body.shape);
    return (box.high - box.low).minCoeff();
}

/// Warns about bodies that sink deep into their support under their own weight.
void check_softness(const Scene& scene, Diagnostics& diagnostics) {
    constexpr double kDeep = 0.2;  // fraction of the body's thickness
    for (const Body& body : scene.bodies) {
        if (!body.surface.stiffness || !body.moves_at_all()) continue;
        const double depth = mass(body) * scene.gravity.norm() / *body.surface.stiffness;
        if (depth < kDeep * thickness(body)) continue;
        diagnostics.warning(
            body.surface.place, "stiffness",
            fmt::format(
                "lets {} sink by {:.3g} mm under its own weight; its thickness is {:.3g} mm",
                body.name, depth * 1e3, thickness(body) * 1e3),
            "Make it stiffer or lighter: a body that sinks too deep comes out on another side.");
    }
}

void check_surfaces(const Scene& scene, Diagnostics& diagnostics) {
    for (const Body& body : scene.bodies) check(body.surface, body.friction, diagnostics);
    const auto has_no_texture = [&](const Surface& surface) {
        if (surface.texture)
            diagnostics.error(surface.texture->place, "texture", "is allowed for bodies only",
                              "Give it to the body that the finger touches.");
    };
    for (const Finger& finger : scene.fingers) {
        check(finger.surface, finger.friction, diagnostics);
        has_no_texture(finger.surface);
    }
    for (const Pair& pair : scene.pairs) {
        has_no_texture(pair.surface);
        check(pair.surface, pair.friction, diagnostics);
        if (!pair.friction && pair.surface == Surface{})
            diagnostics.error(pair.place, "friction", "is missing, and there is no surface",
                              "Give a property of the pair, or leave the pair out.");
    }
}

void check_joints(const Scene& scene, Diagnostics& diagnostics) {
    for (const Joint& joint : scene.joints) {
        check_axis(joint, diagnostics);
        check_curve(joint, diagnostics);
        check_bushing(joint, diagnostics);
        check_points(joint, diagnostics);
        check_start(joint, diagnostics);
        check_masses(joint, scene, diagnostics);
        check_between(joint, scene, diagnostics);
    }
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

/// Radius of a sphere around the body's origin that contains the body [m].
double reach(const Body& body) {
    if (body.shape.kind == ShapeKind::plane) return std::numeric_limits<double>::infinity();
    const Bounds box = bounds(body.shape);
    return box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs()).norm();
}

/// Warns about bodies that start inside a fixed body, because contact forces would push or shoot
/// them out.
void check_overlaps(const Scene& scene, Diagnostics& diagnostics) {
    constexpr double kDeep = 1e-3;  // [m]
    std::vector<double> reaches;
    for (const Body& body : scene.bodies) reaches.push_back(reach(body));
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        const Body& body = scene.bodies[i];
        if (!body.moves_at_all()) continue;
        for (size_t j = 0; j < scene.bodies.size(); ++j) {
            const Body& fixed = scene.bodies[j];
            if (fixed.moves_at_all()) continue;
            if ((body.position - fixed.position).norm() > reaches[i] + reaches[j]) continue;
            double deepest = 0;
            const auto sink = [&](const Body& of, const Body& in) {
                for (const Vec3& p : marks(of.shape)) {
                    deepest =
                        std::max(deepest, depth(in.shape, in.pose().inverse() * (of.pose() * p)));
                }
            };
            sink(body, fixed);
            sink(fixed, body);
            if (deepest < kDeep) continue;
            diagnostics.warning(body.place, body.name,
                                fmt::format("starts {:.3g} mm deep inside the fixed body {}",
                                            deepest * 1e3, fixed.name),
                                "Move it, or expect contact forces to push it out.");
        }
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
