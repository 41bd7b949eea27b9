// Describes the contents of a world, as read from a scene file (docs/files/scene.md).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "scene/camera.h"
#include "scene/joint.h"
#include "scene/lattice.h"
#include "scene/look.h"
#include "scene/proxy_kind.h"
#include "scene/shape.h"
#include "scene/surface.h"

namespace dihaptic::scene {

/// Limits for a scene. Beyond these limits, a unit is wrong, or a body is too light to be simulated
/// together with the others.
constexpr double kLightest = 1e-6;  // [kg]
constexpr double kHeaviest = 1000;  // [kg]
constexpr double kFurthest = 100;   // distance from the world's origin [m]
/// Maximum numbers of bodies, of joints and of pairs. Some checks compare all of them with each
/// other, and even a tenth of this number could not be simulated in real time.
constexpr size_t kMostThings = 4000;
constexpr size_t kMostLattices = 100;

/// A set of the world's axes, where x is 1, y is 2 and z is 4.
enum class Axes { none, x, y, xy, z, xz, yz, xyz };
constexpr auto enum_names(Axes) {
    return std::array{"none", "x", "y", "xy", "z", "xz", "yz", "xyz"};
}
constexpr bool contains(Axes axes, int axis) {
    return (static_cast<int>(axes) >> axis & 1) != 0;
}

struct Body {
    std::string name;
    Shape shape;
    std::optional<double> mass;     ///< mass [kg]; a movable body needs either a mass or a density
    std::optional<double> density;  ///< [kg/m^3]
    bool fixed = false;             ///< never moves
    bool driven = false;            ///< moves as a task drives it, whatever presses on it
    Vec3 position = Vec3::Zero();   ///< initial position of B's origin [m]
    Vec3 rotation = Vec3::Zero();   ///< initial rotation about fixed axes x, then y, then z [rad]
    double friction = 0.8;          ///< see pair_friction()
    /// A contact transmits a moment about its normal of up to friction x radius x normal force; for
    /// a pair, the larger radius is used [m].
    double torsion_radius = 0;
    Axes moves =
        Axes::xyz;  ///< world axes along which it may move; z alone is a bead on an upright string
    Axes turns = Axes::xyz;  ///< world axes about which the body may turn: none, one, or xyz
    Surface surface;
    /// Bodies of the same group do not touch each other; empty if the body belongs to no group.
    std::string group;
    std::string colour;  ///< "#rrggbb"; if empty, the mesh's own colour, or one chosen by the view
    Finish finish = Finish::satin;
    std::optional<Picture> picture;  ///< drawn in place of the colour
    std::optional<SeenMesh> seen;    ///< drawn in place of the shape
    Place place;                     ///< where the scene file describes the body
    bool weighed = false;  ///< whether the file gives a mass or density, even an invalid one

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the body."));
        shape.visit(v);
        v("mass", mass,
          Field::of(Quantity::mass)
              .within(kLightest, kHeaviest)
              .says("Mass; a body that is not fixed needs this or its density."));
        v("density", density,
          Field::of(Quantity::density).within(0.01, 1e5).says("Density, in place of the mass."));
        v("fixed", fixed, says("Whether it never moves."));
        v("driven", driven,
          says("Whether it moves only as driven by a task, whatever presses on it."));
        v("position", position,
          Field::length()
              .within(-kFurthest, kFurthest)
              .says("Position of the origin at the start."));
        v("rotation", rotation,
          Field::of(Quantity::angle)
              .within(-kMostTurn, kMostTurn)
              .says("Rotation at the start, about the world's axes x, then y, then z."));
        v("friction", friction,
          Field::number()
              .within(0, kMostFriction)
              .says("Coefficient of friction; for a pair, the geometric mean is used."));
        v("torsion_radius", torsion_radius,
          Field::length().within(0, 0.1).says("Radius of the soft contact points: each carries a "
                                              "moment up to friction x radius x normal force."));
        v("surface", surface, says("How the surface slides, yields and bounces."));
        v("moves", moves, says("World axes along which it may move."));
        v("turns", turns, says("World axes about which it may turn: none, one, or xyz."));
        v("group", group,
          Field::text().says("Any word; bodies of the same group do not touch each other."));
        v("colour", colour,
          says(
              "Colour, as \"#rrggbb\"; if left out, the mesh's colour or one chosen by the view."));
        v("finish", finish,
          says("How it reflects: like satin plastic, not at all, or like metal in its colour."));
        v("picture", picture, says("Picture of known size that covers it, in place of a colour."));
        v("seen", seen, says("Mesh drawn in place of the shape that is felt."));
        if constexpr (requires { v.place(); }) {
            weighed = v.mentions("mass") || v.mentions("density");
        }
    }

    Pose pose() const { return {rotation_xyz(rotation), position}; }
    /// Whether a force can move the body.
    bool moves_at_all() const {
        return !fixed && !driven && (moves != Axes::none || turns != Axes::none);
    }
};

/// A finger's proxy in the world. Gravity does not act on it. The proxy keeps its canonical
/// orientation or, if the device measures orientation, turns with the device.
struct Finger {
    std::string name;
    Shape shape;
    double mass = 0.001;        ///< [kg]
    double friction = 0.8;      ///< see pair_friction()
    double torsion_radius = 0;  ///< for a soft finger; see Body::torsion_radius [m]
    Surface surface;
    std::optional<ProxyKind> proxy;  ///< used in place of the setting proxy.kind
    Vec3 rotation =
        Vec3::Zero();  ///< canonical orientation: about the fixed axes x, then y, then z [rad]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the finger."));
        shape.visit(v);
        v("mass", mass,
          Field::of(Quantity::mass)
              .within(kLightest, kHeaviest)
              .says("Mass of the finger's proxy."));
        v("friction", friction,
          Field::number()
              .within(0, kMostFriction)
              .says("Coefficient of friction; for a pair, the geometric mean is used."));
        v("torsion_radius", torsion_radius,
          Field::length().within(0, 0.1).says(
              "Radius of a soft finger's contact points, as for a body."));
        v("surface", surface, says("How the surface slides, yields and bounces."));
        v("proxy", proxy,
          says("Kind of the finger's proxy, in place of proxy.kind in the settings."));
        v("rotation", rotation,
          Field::of(Quantity::angle)
              .within(-kMostTurn, kMostTurn)
              .says("Orientation at the device's neutral orientation, about the world's axes x, "
                    "then y, then z."));
    }
};

/// Surface properties of one pair of bodies or fingers. They override the properties that follow
/// from the two surfaces.
struct Pair {
    std::vector<std::string> between;  ///< two names
    std::optional<double> friction;    ///< if unset, the geometric mean of the two coefficients
    Surface surface;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("between", between, Field::text().required().says("Two bodies or fingers."));
        v("friction", friction,
          Field::number()
              .within(0, kMostFriction)
              .says("Coefficient of friction between them, in place of the mean of their own "
                    "coefficients."));
        v("surface", surface,
          says("How they slide on each other, yield and bounce, in place of the combination of "
               "their own surfaces."));
    }
};

struct Scene {
    std::string title;
    Vec3 gravity{0, 0, -9.81};  ///< [m/s^2]
    std::vector<Body> bodies;
    std::vector<Pair> pairs;
    std::vector<Joint> joints;
    std::vector<Lattice> lattices;  ///< as given in a file; complete() makes bodies of them
    /// If a file gives none, these are thumb and index, two pads for a grip along x.
    std::vector<Finger> fingers;
    std::string object;           ///< the body for summaries; if empty, the first movable body
    std::vector<Camera> cameras;  ///< cameras besides those of every scene (view/camera.h)
    Node settings;                ///< settings that this scene requires (frame::Settings)
    Node hand;                    ///< how the simulated hand tries out the scene (hand::HandSpec)
    Place bodies_place;           ///< where the scene file lists the bodies
    Place object_place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("title", title, says("Title of the scene."));
        v("gravity", gravity,
          Field::of(Quantity::acceleration).within(-1000, 1000).says("Gravity."));
        v("bodies", bodies, Field::text().required().says("Bodies, including fixed ones."));
        v("pairs", pairs, says("Pairs with their own friction or surface."));
        v("joints", joints, says("Joints between two bodies, or between a body and the world."));
        v("lattices", lattices, says("Soft bodies made of parts joined by springs."));
        v("fingers", fingers,
          says("Fingers, each with its own device in the rig; if left out, thumb "
               "and index with pads for a grip along x."));
        v("object", object, says("Body for summaries; if left out, the first movable body."));
        v("cameras", cameras,
          says("Cameras besides front, above and side; the first one listed here is then the "
               "default."));
        v("settings", settings, says("Settings that the scene requires."));
        v("hand", hand, says("How the simulated hand tries out the scene."));
        if constexpr (requires { v.place(); }) {
            bodies_place = v.place_of("bodies");
            object_place = v.place_of("object");
            if (v.mentions("fingers") && fingers.empty()) {
                v.diagnostics().error(v.place_of("fingers"), "fingers", "there are none",
                                      "List at least one, or leave it out for thumb and index.");
            }
        }
    }

    /// Index of the body with this name, or -1 if there is none.
    int find(const std::string& name) const;
    /// Index of the body that summaries describe, or -1 if no body can move.
    int object_index() const;
};

/// Names of the fingers, in scene order.
std::vector<std::string> finger_names(const Scene& scene);

/// The recorded joints, which tasks can use; complete() moves them to the start of the list.
std::span<const Joint> recorded_joints(const Scene& scene);

/// The entry in the file for a pair of bodies or fingers, given in either order; null if there is
/// none.
const Pair* find_pair(const Scene& scene, const std::string& a, const std::string& b);

/// Coefficient of friction between two bodies or fingers: the value that the file gives for the
/// pair or, otherwise, the geometric mean of their own coefficients.
double pair_friction(const Scene& scene, const std::string& a, double friction_a,
                     const std::string& b, double friction_b);

/// Mass of a body that is not fixed, computed from its mass or density [kg].
double mass(const Body& body);

/// Whether a body falls freely when nothing touches it, i.e. no joint, rail or axis constrains it.
bool flies(const Scene& scene, const Body& body);

/// Reads a scene file and its meshes, until `stop` is requested. Reports all problems to
/// `diagnostics`, and returns everything that could be read.
Scene read_scene(const std::string& file, Diagnostics& diagnostics,
                 const std::stop_token& stop = {});

/// Reports as an error that the scene has no body with this name, and suggests a similar name.
void report_unknown_body(const std::string& name, const Scene& scene, const Place& place,
                         const char* key, Diagnostics& diagnostics);

/// Fills in the default fingers, loads meshes and pictures, and checks the scene as a whole. File
/// names are relative to `folder`.
void complete(Scene& scene, const std::string& folder, Diagnostics& diagnostics,
              const std::stop_token& stop = {});

}  // namespace dihaptic::scene
