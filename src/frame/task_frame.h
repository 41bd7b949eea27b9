// TaskFrame describes what a task does in a tick: what it displays, how it perturbs the movement,
// and how the trial ended. The task's director orders these actions, the Frame records them, and a
// replay orders them again.
//
// Perturbations act on:
//   visual map        from true to displayed poses of selected objects
//   body properties   inertia, weight and friction, as factors on the scene's values
//   joint properties  springs, dampers and dry friction, as factors on the scene's values
//   loads             forces and torques on handles and bodies
//
// In addition, objects can be hidden, coloured and scaled (looks) or shown at earlier poses
// (displaced), texts can be shown over the scene (message, lines), and a page can replace the
// scene.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "base/geometry.h"
#include "frame/term.h"
#include "scene/finger_set.h"

namespace dihaptic::frame {

/// Flags for the objects that a visual map moves; several flags are added up.
enum Moves : uint32_t { kMovesProxies = 1, kMovesObject = 2, kMovesTargets = 4 };

/// The difference between displayed and true poses. A point p is shown at
///
///     c + R S (p - c),   S = diag(scale)         or, on a ray,     c + |p - c| along
///
/// A body is also turned by R, so that a rotated hand still touches the objects rotated with it.
struct VisualMap {
    uint32_t moves = 0;  ///< Moves
    int32_t object = -1;
    Vec3 p_WC = Vec3::Zero();  ///< c
    Vec3 scale = Vec3::Ones();
    Quat R = Quat::Identity();
    Vec3 along_W = Vec3::Zero();
    double size = 1;
    double delay = 0;
    Vec3 noise = Vec3::Zero();
    Vec3 shift_W = Vec3::Zero();

    Vec3 displayed(const Vec3& p_W) const noexcept {
        const Vec3 arm = p_W - p_WC;
        if (along_W != Vec3::Zero()) return p_WC + arm.norm() * along_W + shift_W;
        return p_WC + R * scale.cwiseProduct(arm) + shift_W;
    }
    Pose displayed(const Pose& X_W) const noexcept { return {R * X_W.R, displayed(X_W.p)}; }

    template <class Self, class Visitor>
    static void visit(Self& m, Visitor& v) {
        v(m.moves,
          {"moves", "1", "", "Sum over what the map moves: 1 proxies, 2 object, 4 targets."});
        v(m.object, {"object", "1", "", "Index of the object's body; -1: none."});
        v(m.p_WC, {"centre", "m", "W", "Centre of the map."});
        v(m.scale, {"scale", "1", "W", "Factors on distances from the centre along each axis."});
        v(m.R, {"rotation", "1", "W", "Rotation about the centre, after scaling."});
        v(m.along_W, {"along", "1", "W",
                      "Unit direction of the ray on which points are shown; zero: no ray."});
        v(m.size, {"size", "1", "", "Ratio of the object's displayed to its true size."});
        v(m.delay, {"delay", "s", "", "Display delay of the objects that the map moves."});
        v(m.noise,
          {"noise", "m", "W",
           "Standard deviation of the noise on their displayed positions, along each axis."});
        v(m.shift_W, {"shift", "m", "W", "Displacement of the displayed objects, applied last."});
    }
};

struct TargetFrame {
    int32_t region = -1;
    Vec3 p_WT = Vec3::Zero();
    double radius = 0;
    int32_t colour = -1;

    template <class Self, class Visitor>
    static void visit(Self& t, Visitor& v) {
        v(t.region, {"region", "1", "", "Index of the region in the task's list."});
        v(t.p_WT, {"position", "m", "W", "Centre of the sphere."});
        v(t.radius, {"radius", "m", "", "Radius of the sphere."});
        v(t.colour, {"colour", "1", "",
                     "Colour: 65536 red + 256 green + blue, each 0 to 255; -1: the default colour "
                     "of targets."});
    }
};

struct PropertiesFrame {
    int32_t body = -1;
    Vec3 mass_scale = Vec3::Ones();
    double weight_scale = 1;
    double turning_scale = 1;
    double friction_scale = 1;
    double stiffness_scale = 1;
    double restitution_scale = 1;
    double texture_wavelength_scale = 1;
    double texture_height_scale = 1;
    double texture_friction_scale = 1;

    template <class Self, class Visitor>
    static void visit(Self& p, Visitor& v) {
        v(p.body,
          {"body", "1", "", "Index of the body; fingers' proxies come after the scene's bodies."});
        v(p.mass_scale, {"mass_scale", "1", "W", "Factors on the body's inertia along each axis."});
        v(p.weight_scale, {"weight_scale", "1", "", "Factor on the body's weight."});
        v(p.turning_scale, {"turning_scale", "1", "", "Factor on the body's moments of inertia."});
        v(p.friction_scale,
          {"friction_scale", "1", "", "Factor on the body's coefficients of friction."});
        v(p.stiffness_scale, {"stiffness_scale", "1", "",
                              "Factor on the stiffness and damping of the body's surface."});
        v(p.restitution_scale,
          {"restitution_scale", "1", "", "Factor on the restitution of the body's surface."});
        v(p.texture_wavelength_scale,
          {"texture_wavelength_scale", "1", "", "Factor on the wavelength of the body's texture."});
        v(p.texture_height_scale,
          {"texture_height_scale", "1", "", "Factor on the height of the body's texture."});
        v(p.texture_friction_scale,
          {"texture_friction_scale", "1", "",
           "Factor on the variation of friction along the body's texture."});
    }
};

struct JointPropertiesFrame {
    int32_t joint = -1;
    double stiffness_scale = 1;
    double damping_scale = 1;
    double friction_scale = 1;

    template <class Self, class Visitor>
    static void visit(Self& p, Visitor& v) {
        v(p.joint, {"joint", "1", "", "Index of the joint in the scene."});
        v(p.stiffness_scale,
          {"stiffness_scale", "1", "", "Factor on the stiffness of the joint's spring."});
        v(p.damping_scale,
          {"damping_scale", "1", "", "Factor on the damping of the joint's damper."});
        v(p.friction_scale, {"friction_scale", "1", "", "Factor on the joint's dry friction."});
    }
};

struct LoadFrame {
    int32_t body = -1;
    Vec3 force_W = Vec3::Zero();
    Vec3 torque_W = Vec3::Zero();

    template <class Self, class Visitor>
    static void visit(Self& l, Visitor& v) {
        v(l.body,
          {"body", "1", "", "Index of the body; fingers' proxies come after the scene's bodies."});
        v(l.force_W, {"force", "N", "W", "Force at the body's centre of mass, or on the handle."});
        v(l.torque_W, {"torque", "N*m", "W", "Torque on the body or the handle."});
    }
};

struct PlacementFrame {
    int32_t body = -1;
    Pose X_WB;
    Vec3 v_WB = Vec3::Zero();
    Vec3 w_WB = Vec3::Zero();

    template <class Self, class Visitor>
    static void visit(Self& p, Visitor& v) {
        v(p.body, {"body", "1", "", "Index of the body."});
        v(p.X_WB.p, {"position", "m", "W", "Position of the body's origin."});
        v(p.X_WB.R, {"orientation", "1", "W",
                     "Unit quaternion that turns the body's axes into the world's."});
        v(p.v_WB, {"velocity", "m/s", "W", "Velocity given to the body's origin at this pose."});
        v(p.w_WB, {"angular_velocity", "rad/s", "W", "Angular velocity given to the body."});
    }
};

struct DriveFrame {
    int32_t body = -1;
    Pose X_WB;

    template <class Self, class Visitor>
    static void visit(Self& d, Visitor& v) {
        v(d.body, {"body", "1", "", "Index of the body."});
        v(d.X_WB.p,
          {"position", "m", "W", "Position of the body's origin at the end of the tick."});
        v(d.X_WB.R, {"orientation", "1", "W",
                     "Unit quaternion that turns the body's axes into the world's at that time."});
    }
};

struct MotorFrame {
    int32_t joint = -1;
    uint32_t follows = 0;
    double position = 0;
    double most_force = 0;
    double push = 0;

    template <class Self, class Visitor>
    static void visit(Self& m, Visitor& v) {
        v(m.joint, {"joint", "1", "", "Index of the joint in the scene."});
        v(m.follows,
          {"follows", "1", "", "1 if the motor moves the joint to a position, otherwise 0."});
        v(m.position,
          {"position", "1", "", "Desired joint position at the end of the tick, in m or rad."});
        v(m.most_force, {"most_force", "1", "",
                         "Largest force (N), or torque for a hinge (N*m), of this motion."});
        v(m.push, {"push", "1", "", "Additional force (N), or torque for a hinge (N*m)."});
    }
};

struct VariableFrame {
    double value = 0;

    template <class Self, class Visitor>
    static void visit(Self& x, Visitor& v) {
        v(x.value, {"value", "1", "", "Value of the variable, in the SI unit of its kind."});
    }
};

struct LookFrame {
    int32_t body = -1;
    uint32_t hidden = 0;
    int32_t colour = -1;
    double scale = 1;

    template <class Self, class Visitor>
    static void visit(Self& l, Visitor& v) {
        v(l.body,
          {"body", "1", "", "Index of the body; fingers' proxies come after the scene's bodies."});
        v(l.hidden,
          {"hidden", "1", "", "1 if neither the body nor its shadow is shown, otherwise 0."});
        v(l.colour, {"colour", "1", "",
                     "Colour: 65536 red + 256 green + blue, each 0 to 255; -1: the body's own."});
        v(l.scale, {"scale", "1", "", "Factor on the body's displayed size."});
    }
};

struct DisplacedFrame {
    int32_t body = -1;
    Pose X_WB;

    template <class Self, class Visitor>
    static void visit(Self& d, Visitor& v) {
        v(d.body,
          {"body", "1", "", "Index of the body; fingers' proxies come after the scene's bodies."});
        v(d.X_WB.p, {"position", "m", "W", "Displayed position, including the visual map."});
        v(d.X_WB.R, {"orientation", "1", "W",
                     "Unit quaternion that turns the displayed body's axes into the world's."});
    }
};

struct SoundFrame {
    int32_t sound = -1;
    uint32_t on = 0;

    template <class Self, class Visitor>
    static void visit(Self& s, Visitor& v) {
        v(s.sound, {"sound", "1", "", "Index of the sound in the session's list."});
        v(s.on, {"on", "1", "", "1 if the sound starts in the tick, 0 if it ends."});
    }
};

struct LineFrame {
    int32_t message = -1;

    template <class Self, class Visitor>
    static void visit(Self& l, Visitor& v) {
        v(l.message, {"message", "1", "", "Index of the text in the session's list of messages."});
    }
};

struct NumberFrame {
    double value = 0;

    template <class Self, class Visitor>
    static void visit(Self& n, Visitor& v) {
        v(n.value, {"value", "1", "", "The number, in the unit that its name in the text states."});
    }
};

/// The kind of index in the items of a list (the member `body`, `joint` or `object`). The index -1
/// means none.
enum class Names { nothing, bodies, bodies_and_proxies, joints };

/// The counts that determine the lengths of the lists.
struct Sizes {
    size_t bodies = 0;  ///< number of bodies in the scene
    size_t fingers = scene::kMostFingers;
};

/// The properties of a list in a TaskFrame, apart from its items.
struct TaskList {
    const char* name;
    const char* meaning;  ///< description in one sentence
    Names names = Names::nothing;
    size_t fixed = 0;
    bool per_body = false, per_finger = false;
    bool perturbs = false;  ///< whether the items are perturbations of the trial

    /// Maximum length of the list in a tick.
    constexpr size_t most(const Sizes& sizes) const {
        return fixed + (per_body ? sizes.bodies : 0) + (per_finger ? sizes.fingers : 0);
    }
    constexpr TaskList of(Names what) const {
        TaskList out = *this;
        out.names = what;
        return out;
    }
    constexpr TaskList up_to(size_t count) const {
        TaskList out = *this;
        out.fixed = count;
        return out;
    }
    constexpr TaskList one_for_each_body() const {
        TaskList out = *this;
        out.per_body = true;
        return out;
    }
    constexpr TaskList one_for_each_finger() const {
        TaskList out = *this;
        out.per_finger = true;
        return out;
    }
    constexpr TaskList is_perturbation() const {
        TaskList out = *this;
        out.perturbs = true;
        return out;
    }
};

/// The actions of a task in a tick. Each list is declared once, in visit_lists(), from which its
/// length, its checks, and the event "perturbation" are derived.
struct TaskFrame {
    /// Maximum numbers of items in a tick.
    static constexpr size_t kMostTargets = 16;
    static constexpr size_t kMostProperties = 8;
    static constexpr size_t kMostLoads = 16;
    static constexpr size_t kMostMotors = 8;
    static constexpr size_t kMostVariables = 64;
    static constexpr size_t kMostSounds = 32;
    static constexpr size_t kMostLines = 6;
    static constexpr size_t kMostNumbers = 28;

    int32_t attempt = 0;
    int32_t outcome = -1;
    int32_t message = -1;
    int32_t marker = 0;
    double share = 0;
    int32_t page = -1;
    std::vector<VisualMap> visual;
    std::vector<TargetFrame> targets;
    std::vector<PropertiesFrame> properties;
    std::vector<JointPropertiesFrame> joint_properties;
    std::vector<LoadFrame> loads;
    std::vector<PlacementFrame> placements;
    std::vector<DriveFrame> drives;
    std::vector<MotorFrame> motors;
    std::vector<VariableFrame> variables;
    std::vector<LookFrame> looks;
    std::vector<DisplacedFrame> displaced;
    std::vector<SoundFrame> sounds;
    std::vector<LineFrame> lines;
    std::vector<NumberFrame> numbers;

    /// Reserves memory for all lists of a tick.
    void reserve(const Sizes& sizes) {
        visit_lists(*this, [&](auto& list, const TaskList& is) { list.reserve(is.most(sizes)); });
    }
    /// Resizes all lists to their maximum lengths; the items have no meaning.
    void fill(const Sizes& sizes) {
        visit_lists(*this, [&](auto& list, const TaskList& is) { list.resize(is.most(sizes)); });
    }
    /// Removes all orders, but keeps the memory.
    void clear() noexcept {
        attempt = 0;
        outcome = message = page = -1;
        marker = 0;
        share = 0;
        visit_lists(*this, [](auto& list, const TaskList&) { list.clear(); });
    }
    /// Whether any perturbation acts.
    bool perturbed() const noexcept {
        bool out = false;
        visit_lists(*this, [&](const auto& list, const TaskList& is) {
            out |= is.perturbs && !list.empty();
        });
        return out;
    }

    /// Calls v(list, TaskList) for each list, in the order of the log.
    template <class Self, class Visitor>
    static void visit_lists(Self& t, Visitor&& v) {
        visit_acting(t, v);
        visit_shown(t, v);
    }

    template <class Self, class Visitor>
    static void visit(Self& t, Visitor& v) {
        v(t.attempt, {"attempt", "1", "", "Number of the attempt at the trial, from 1."});
        v(t.outcome,
          {"outcome", "1", "",
           "Index of the trial's outcome in the session's list, in the trial's last tick."});
        v(t.message, {"message", "1", "", "Index of the shown message in the session's list."});
        v(t.marker, {"marker", "1", "", "Event code of the tick, 1 to 255; 0: none."});
        v(t.share, {"share", "1", "", "Fraction of the trial's perturbation that acts."});
        v(t.page, {"page", "1", "", "Index of the shown page in the session's list."});
        visit_lists(t, [&](auto& list, const TaskList& is) { v.each(is.name, list, is.meaning); });
    }

  private:
    template <class Self, class Visitor>
    static void visit_acting(Self& t, Visitor& v) {
        using enum Names;
        v(t.visual,
          TaskList{"visual",
                   "The visual map, if any: the difference between displayed and true poses."}
              .of(bodies)
              .up_to(1)
              .is_perturbation());
        v(t.targets,
          TaskList{"targets", "One for each target, shown as a sphere."}.up_to(kMostTargets));
        v(t.properties,
          TaskList{"properties", "One for each body whose properties differ from the scene's."}
              .of(bodies_and_proxies)
              .up_to(kMostProperties)
              .is_perturbation());
        v(t.joint_properties,
          TaskList{"joint_properties",
                   "One for each joint whose properties differ from the scene's."}
              .of(joints)
              .up_to(kMostProperties)
              .is_perturbation());
        v(t.loads, TaskList{"loads", "One for each force on a body or a handle."}
                       .of(bodies_and_proxies)
                       .up_to(kMostLoads)
                       .is_perturbation());
        v(t.placements, TaskList{"placements", "One for each body that is placed at a pose."}
                            .of(bodies)
                            .one_for_each_body());
        v(t.drives, TaskList{"drives", "One for each driven body: its pose at the end of the tick."}
                        .of(bodies)
                        .one_for_each_body());
        v(t.motors,
          TaskList{"motors", "One for each joint that a motor turns or moves."}.of(joints).up_to(
              kMostMotors));
    }
    template <class Self, class Visitor>
    static void visit_shown(Self& t, Visitor& v) {
        using enum Names;
        v(t.variables,
          TaskList{"variables",
                   "One for each variable of the task: its value in this trial or, in the trial's "
                   "last tick, its value in the next trial."}
              .up_to(kMostVariables));
        v(t.looks,
          TaskList{"looks",
                   "One for each body or proxy that is hidden, or drawn differently from the "
                   "scene."}
              .of(bodies_and_proxies)
              .one_for_each_body()
              .one_for_each_finger());
        v(t.displaced,
          TaskList{
              "displaced",
              "One for each body or proxy that is shown delayed, shaken, or at an earlier pose."}
              .of(bodies_and_proxies)
              .up_to(1)
              .one_for_each_finger());
        v(t.sounds, TaskList{"sounds", "One for each sound that starts or ends in the tick."}.up_to(
                        kMostSounds));
        v(t.lines,
          TaskList{"lines", "One for each text shown below the message."}.up_to(kMostLines));
        v(t.numbers,
          TaskList{"numbers",
                   "One for each number in the shown texts, the message's first, then the lines'."}
              .up_to(kMostNumbers));
    }
};

/// Adds an item to a list of a TaskFrame unless the list is full, so that no memory is allocated
/// during a tick.
template <class T>
void add(std::vector<T>& list, const T& item) noexcept {
    if (list.size() < list.capacity()) list.push_back(item);
}

}  // namespace dihaptic::frame
