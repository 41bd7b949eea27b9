// Describes what a world is made of, as read from a scene file (docs/files/scene.md).
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

/// Limits of what a scene may hold. Beyond them a unit is wrong, or a body is too light to be
/// simulated together with others.
constexpr double kLightest = 1e-6;  // [kg]
constexpr double kHeaviest = 1000;  // [kg]
constexpr double kFurthest = 100;   // from the world's origin [m]
/// Largest number of bodies, of joints and of pairs. Some checks compare each two of them, and no
/// tick could step a tenth of them.
constexpr size_t kMostThings = 4000;
constexpr size_t kMostLattices = 100;

/// A set of world axes: x is 1, y is 2, z is 4.
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
    std::optional<double> mass;     ///< [kg]; this or the density, unless the body is fixed
    std::optional<double> density;  ///< [kg/m^3]
    bool fixed = false;             ///< never moves
    bool driven = false;            ///< moves where a task drives it, whatever presses on it
    Vec3 position = Vec3::Zero();   ///< of B's origin at the start [m]
    Vec3 rotation = Vec3::Zero();   ///< at the start, about the fixed axes x, then y, then z [rad]
    double friction = 0.8;          ///< see pair_friction()
    double torsion_radius = 0;  ///< a contact carries a moment about its normal up to friction x
                                ///< radius x normal force; of a pair, the larger counts [m]
    Axes moves =
        Axes::xyz;  ///< world axes along which it may move: z is a bead on an upright string
    Axes turns = Axes::xyz;  ///< world axes about which it may turn: none, one, or xyz
    Surface surface;
    std::string group;   ///< bodies of one group do not touch each other; empty: of none
    std::string colour;  ///< "#rrggbb"; empty: the mesh's own, or the view chooses
    Finish finish = Finish::satin;
    std::optional<Picture> picture;  ///< in place of a colour
    std::optional<SeenMesh> seen;    ///< drawn in place of the shape
    Place place;                     ///< in the scene file
    bool weighed = false;  ///< the file has a key for its mass or density, even if a wrong one

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the body."));
        shape.visit(v);
        v("mass", mass,
          Field::of(Quantity::mass)
              .within(kLightest, kHeaviest)
              .says("Mass; a body that is not fixed has this or its density."));
        v("density", density,
          Field::of(Quantity::density).within(0.01, 1e5).says("Density, in place of the mass."));
        v("fixed", fixed, says("Whether it never moves."));
        v("driven", driven,
          says("Whether it moves as a task drives it and not otherwise, whatever presses on it."));
        v("position", position,
          Field::length()
              .within(-kFurthest, kFurthest)
              .says("Position of its origin at the start."));
        v("rotation", rotation,
          Field::of(Quantity::angle)
              .within(-kMostTurn, kMostTurn)
              .says("Rotation at the start, about the world's axes x, then y, then z."));
        v("friction", friction,
          Field::number()
              .within(0, kMostFriction)
              .says("Coefficient of friction; of a pair, the geometric mean counts."));
        v("torsion_radius", torsion_radius,
          Field::length().within(0, 0.1).says("Radius of its soft contact points: each carries a "
                                              "moment up to friction x radius x normal force."));
        v("surface", surface, says("How its surface slides, gives way and bounces."));
        v("moves", moves, says("World axes along which it may move."));
        v("turns", turns, says("World axes about which it may turn: none, one, or xyz."));
        v("group", group,
          Field::text().says("A word; bodies with the same one do not touch each other."));
        v("colour", colour,
          says("Colour, as \"#rrggbb\"; left out, that of its mesh, or the view chooses."));
        v("finish", finish,
          says("How it reflects: as satin plastic, not at all, or as a metal of its colour."));
        v("picture", picture, says("Picture of known size over it, in place of a colour."));
        v("seen", seen, says("Mesh that is drawn in place of its shape, which is felt."));
        if constexpr (requires { v.place(); }) {
            place = v.place();
            weighed = v.mentions("mass") || v.mentions("density");
        }
    }

    Pose pose() const { return {rotation_xyz(rotation), position}; }
    /// Whether a force can make it move.
    bool moves_at_all() const {
        return !fixed && !driven && (moves != Axes::none || turns != Axes::none);
    }
};

/// A finger's proxy in the world. Gravity does not act on it. It keeps its canonical orientation
/// or, with a device that measures orientation, turns from it.
struct Finger {
    std::string name;
    Shape shape;
    double mass = 0.001;        ///< [kg]
    double friction = 0.8;      ///< see pair_friction()
    double torsion_radius = 0;  ///< of a soft finger; see Body [m]
    Surface surface;
    std::optional<ProxyKind> proxy;  ///< overrides the setting proxy.kind
    Vec3 rotation =
        Vec3::Zero();  ///< canonical orientation, about the fixed axes x, then y, then z [rad]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the finger."));
        shape.visit(v);
        v("mass", mass,
          Field::of(Quantity::mass).within(kLightest, kHeaviest).says("Mass of its proxy."));
        v("friction", friction,
          Field::number()
              .within(0, kMostFriction)
              .says("Coefficient of friction; of a pair, the geometric mean counts."));
        v("torsion_radius", torsion_radius,
          Field::length().within(0, 0.1).says("Radius of a soft finger, as of a body."));
        v("surface", surface, says("How its surface slides, gives way and bounces."));
        v("proxy", proxy,
          says("What stands for the finger in the world, in place of proxy.kind of the settings."));
        v("rotation", rotation,
          Field::of(Quantity::angle)
              .within(-kMostTurn, kMostTurn)
              .says("Orientation while its device is in the neutral one, about the world's axes x, "
                    "then y, then z."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Surface of one pair of bodies or fingers: what it says overrides what follows from their own.
struct Pair {
    std::vector<std::string> between;  ///< two names
    std::optional<double> friction;    ///< none: the geometric mean
    Surface surface;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("between", between, Field::text().required().says("Two bodies or fingers."));
        v("friction", friction,
          Field::number()
              .within(0, kMostFriction)
              .says("Coefficient of friction between them, in place of the mean of their own."));
        v("surface", surface,
          says("How they slide on each other, give way and bounce, in place of what follows from "
               "their own surfaces."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

struct Scene {
    std::string title;
    Vec3 gravity{0, 0, -9.81};  ///< [m/s^2]
    std::vector<Body> bodies;
    std::vector<Pair> pairs;
    std::vector<Joint> joints;
    std::vector<Lattice> lattices;  ///< of a file; complete() makes bodies and joints of them
    std::vector<Finger> fingers;  ///< empty in a file: thumb and index, two pads for a grip along x
    std::string object;  ///< the body that summaries are about; empty: the first one that can move
    std::vector<Camera> cameras;  ///< in addition to those that every scene has (view/camera.h)
    Node settings;                ///< settings that this scene asks for (frame::Settings)
    Node hand;                    ///< how the simulated hand tries out the scene (hand::HandSpec)
    Place bodies_place;           ///< in the scene file
    Place object_place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("title", title, says("Title of the scene."));
        v("gravity", gravity,
          Field::of(Quantity::acceleration).within(-1000, 1000).says("Gravity."));
        v("bodies", bodies, Field::text().required().says("Bodies, fixed ones included."));
        v("pairs", pairs, says("Pairs with a friction or surface of their own."));
        v("joints", joints, says("Joints between two bodies, or a body and the world."));
        v("lattices", lattices, says("Soft bodies that are made of parts joined by springs."));
        v("fingers", fingers,
          says("Fingers, each with a device of its own in the rig; left out, thumb "
               "and index with pads for a grip along x."));
        v("object", object,
          says("Body that summaries are about; left out, the first that can move."));
        v("cameras", cameras,
          says("Cameras besides front, above and side; the first one here is then the default."));
        v("settings", settings, says("Settings that the scene asks for."));
        v("hand", hand, says("How the simulated hand tries out the scene."));
        if constexpr (requires { v.place(); }) {
            bodies_place = v.place_of("bodies");
            object_place = v.place_of("object");
            if (v.mentions("fingers") && fingers.empty()) {
                v.diagnostics().error(v.place_of("fingers"), "fingers", "there are none",
                                      "List one at least, or leave it out: thumb and index.");
            }
        }
    }

    /// Index of the named body, or -1.
    int find(const std::string& name) const;
    /// Index of the body that summaries are about, or -1 if nothing can move.
    int object_index() const;
};

/// Names of the fingers, in order.
std::vector<std::string> finger_names(const Scene& scene);

/// The joints that are recorded and may be named in tasks; complete() puts them first.
std::span<const Joint> recorded_joints(const Scene& scene);

/// What the file says of a pair of bodies or fingers, in any order, or null.
const Pair* find_pair(const Scene& scene, const std::string& a, const std::string& b);

/// Coefficient of friction between two bodies or fingers: the file's value for the pair, or else
/// the geometric mean of their own coefficients.
double pair_friction(const Scene& scene, const std::string& a, double friction_a,
                     const std::string& b, double friction_b);

/// Mass of a body that is not fixed, from its mass or its density [kg].
double mass(const Body& body);

/// Whether a body falls freely where nothing touches it: no joint, rail or axis holds it.
bool flies(const Scene& scene, const Body& body);

/// Reads a scene file and its meshes, until `stop`. Reports all problems to `diagnostics` and
/// returns what could be read.
Scene read_scene(const std::string& file, Diagnostics& diagnostics,
                 const std::stop_token& stop = {});

/// Reports the error that the scene has no body of this name, with the one that may be meant.
void report_unknown_body(const std::string& name, const Scene& scene, const Place& place,
                         const char* key, Diagnostics& diagnostics);

/// Fills in the default fingers, loads meshes and pictures, and checks the scene as a whole. Paths
/// of files are relative to `folder`.
void complete(Scene& scene, const std::string& folder, Diagnostics& diagnostics,
              const std::stop_token& stop = {});

}  // namespace dihaptic::scene
