// Loads: forces and torques on handles and bodies that depend on their position and velocity.
//
//     constant   f = f0,  t = t0
//     viscous    f = -b v
//     curl       f = b e x v
//     general    f = f0 + A (p - p0) + B v
//     spring     f = -k d - b v_d
//     channel    the same, with k > 0
//     link       f = -(k (|d| - L) + b d/dt |d|) d / |d| acts on one thing, and -f on the other
//
// p and v are the position and velocity of the handle or body; d is the vector to p from a point,
// or from the nearest point of a line or plane, and v_d is the component of v that changes d. In a
// link, d points from the other thing to this one: a spring or rod pulls and pushes, a rope only
// pulls, and a wall between two hands only pushes. Beyond a zone around p0, or around the point,
// line or plane, a load fades to zero: it is multiplied by a factor that decreases linearly with
// distance.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "frame/task_frame.h"
#include "scene/scene.h"
#include "task/effects/load/motions.h"
#include "task/file/ref.h"
#include "task/file/region.h"

namespace dihaptic::task {

class Load;
class Names;
struct Thing;  ///< what a load acts on: a body, or the handle of a finger

enum class LoadKind { constant, viscous, curl, general, spring, channel, link };
constexpr auto enum_names(LoadKind) {
    return std::array{"constant", "viscous", "curl", "general", "spring", "channel", "link"};
}

/// Directions in which a link's force can act: rods pull and push, ropes only pull, walls only
/// push.
enum class LinkActs { both, pulls, pushes };
constexpr auto enum_names(LinkActs) {
    return std::array{"both", "pulls", "pushes"};
}

/// A load as described in an experiment file. Keys that its kind does not use are reported as
/// unknown.
struct LoadSpec {
    using Effect = Load;

    LoadKind kind = LoadKind::viscous;
    Refs<Thing> on;
    FormulaVec3 force;           ///< f0 [N]
    FormulaVec3 torque;          ///< t0 [N*m]
    Formula damping = 0;         ///< b [N*s/m]
    Formula stiffness = 0;       ///< k; the load pushes away if it is negative [N/m]
    Mat3 A = Mat3::Zero();       ///< [N/m]
    Mat3 B = Mat3::Zero();       ///< [N*s/m]
    Ref<Region> about;           ///< p0, or a point of the line or plane
    std::optional<Vec3> axis;    ///< axis e of a curl field, or direction of a spring's line
    std::optional<Vec3> normal;  ///< normal of a spring's or channel's plane
    Ref<Region> from;            ///< start of the line to which the load pulls
    Ref<Region> to;              ///< another point of that line, toward which it leads from `from`
    /// Direction in which motion is free; it spans a plane with the line.
    std::optional<Vec3> free;
    bool one_sided = false;      ///< whether a plane acts only on the side opposite to its normal
    std::optional<double> zone;  ///< distance at which fading starts [m]
    double fade = 0.01;          ///< distance over which the load fades [m]
    Refs<Thing> between;         ///< the two bodies or fingers that a link joins
    Formula length = 0;          ///< rest length L of a link [m]
    LinkActs acts = LinkActs::both;
    Formula delay = 0;  ///< age of the p and v from which the load is computed [s]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind, Field::text().required().says("Law of the load."));
        if (kind == LoadKind::link) {
            v("between", between,
              Field::text().required().says("The two bodies or fingers that the link joins."));
        } else {
            v("on", on,
              Field::text().required().says("Bodies, and fingers on whose handles the load acts."));
        }
        switch (kind) {
            case LoadKind::constant:
                visit_force(v);
                v("torque", torque,
                  Field::of(Quantity::torque)
                      .within(-10, 10)
                      .says("Torque on bodies, and on handles of devices that render torque."));
                break;
            case LoadKind::viscous:
                visit_damping(v);
                break;
            case LoadKind::curl:
                visit_damping(v);
                v("axis", axis, direction().says("Axis of the field, right-handed."));
                break;
            case LoadKind::general:
                visit_general(v);
                break;
            case LoadKind::spring:
                v("stiffness", stiffness,
                  Field::of(Quantity::stiffness)
                      .within(-1e5, 1e5)
                      .says("Stiffness; the load pushes away if it is negative."));
                visit_place(v);
                v("axis", axis, direction().says("Direction of a line through the region."));
                v("one_sided", one_sided,
                  says("Whether a plane acts only on the side opposite to its normal."));
                visit_zone(v, "safe_within");
                break;
            case LoadKind::channel:
                v("stiffness", stiffness,
                  Field::of(Quantity::stiffness).within(0, 1e5).says("Stiffness."));
                visit_place(v);
                visit_zone(v, "break_out");
                break;
            case LoadKind::link:
                visit_link(v);
                break;
        }
        if (kind != LoadKind::constant)
            v("delay", delay,
              Field::of(Quantity::time)
                  .within(0, 2)
                  .says("Age of the position and velocity from which the load is computed."));
    }

    /// Whether the load is a field whose force depends on velocity, alone or together with other
    /// terms.
    bool pushes_by_velocity() const;

  private:
    static constexpr Field direction() { return Field::number().within(-1000, 1000); }
    template <class Visitor>
    void visit_force(Visitor& v) {
        v("force", force,
          Field::of(Quantity::force)
              .within(-1000, 1000)
              .says("Force independent of position and velocity."));
    }
    template <class Visitor>
    void visit_damping(Visitor& v) {
        v("damping", damping,
          Field::of(Quantity::damping)
              .within(-1000, 1000)
              .says("Damping; if it is negative, the load amplifies motion."));
    }
    template <class Visitor>
    void visit_place(Visitor& v) {
        visit_damping(v);
        v("about", about,
          says("Region whose centre is the point, or a point of the line or plane."));
        v("normal", normal, direction().says("Normal of a plane through the region."));
        v("from", from, says("Region from which the line leads."));
        v("to", to, says("Region to which the line leads."));
        v("free", free, direction().says("Direction that spans a plane with the line."));
    }
    template <class Visitor>
    void visit_general(Visitor& v) {
        v("A", A,
          Field::of(Quantity::stiffness)
              .within(-1e5, 1e5)
              .says("Matrix that multiplies the position relative to the region's centre."));
        v("B", B,
          Field::of(Quantity::damping)
              .within(-1000, 1000)
              .says("Matrix that multiplies the velocity."));
        visit_force(v);
        v("about", about, says("Region whose centre is p0."));
        visit_zone(v, "safe_within");
    }
    template <class Visitor>
    void visit_link(Visitor& v) {
        v("stiffness", stiffness, Field::of(Quantity::stiffness).within(0, 1e5).says("Stiffness."));
        v("damping", damping,
          Field::of(Quantity::damping).within(0, 1000).says("Damping of its length."));
        v("length", length,
          Field::length().within(0, 100).says("Distance of its ends at which a link is slack."));
        v("acts", acts, says("Whether the link pulls, pushes, or does both."));
    }
    template <class Visitor>
    void visit_zone(Visitor& v, const char* name) {
        v(name, zone,
          Field::length().positive().at_most(10).says(
              "Distance beyond which the load fades; if omitted, the load does not fade."));
        v("fade", fade,
          Field::length().within(1e-4, 10).says("Distance over which the load fades to zero."));
    }
};

/// Appends a description of the load's kind and size to `out`, for a report.
void say(const LoadSpec& spec, std::vector<std::string>& out);

/// A load whose names have been looked up. It does not allocate or throw during a tick.
class Load {
  public:
    /// Problems in the spec are added to `diagnostics`.
    Load(const LoadSpec& spec, const Names& names, const scene::Scene& scene,
         Diagnostics& diagnostics);

    const LoadSpec& spec() const { return spec_; }
    /// Whether any of the load's numbers is a formula.
    bool is_computed() const;
    double stiffness() const { return spec_.stiffness.value; }
    double delay() const { return spec_.delay.value; }
    /// Upper bound on the load's delay [s].
    double longest_delay() const;
    /// Indices of the things that the load acts on: bodies of the scene, followed by fingers.
    std::span<const int> on() const { return spec_.on.indices; }
    void order(double share, std::span<const Vec3> regions_W, const Motions& motions,
               frame::TaskFrame& out) const noexcept;
    template <class Visitor>
    void visit(Visitor& v) {
        spec_.visit(v);
    }
    /// Returns the load's force and torque on a thing that moves with `motion`. `regions_W` are the
    /// centres of the regions [m].
    Wrench act(double share, std::span<const Vec3> regions_W, const Motion& motion) const noexcept;
    /// Matrix that maps velocity to the load's force at share 1 [N*s/m]; zero for channels and
    /// springs.
    Mat3 velocity_gain() const;
    /// Axis of a curl field; unset for other loads.
    std::optional<Vec3> axis() const;

    /// The greatest demands that the load makes on a control loop: norms of the matrices that map
    /// position and velocity to its force, and its largest force and torque.
    struct Demand {
        double stiffness = 0;  ///< largest stiffness, including that due to fading [N/m]
        double damping = 0;    ///< [N*s/m]
        double driving = 0;    ///< largest negative damping, which amplifies motion [N*s/m]
        double force = 0;  ///< largest force at rest; infinite if the force grows with distance [N]
        double torque = 0;  ///< [N*m]
        /// The load holds a hand in place and may be as stiff as the device allows.
        bool holds = false;
        bool springs = false;  ///< the force is proportional to displacement rather than speed
    };
    Demand demand() const;

  private:
    enum class Shape { point, line, plane };
    void check_things(const Names& names, const scene::Scene& scene,
                      Diagnostics& diagnostics) const;
    void look_up_place(const Names& names, Diagnostics& diagnostics);
    void check_spring(Diagnostics& diagnostics) const;
    void check_general(Diagnostics& diagnostics);
    void check_link(Diagnostics& diagnostics) const;
    void order_link(double share, const Motions& motions, frame::TaskFrame& out) const noexcept;
    Vec3 pull(double share, std::span<const Vec3> regions_W, const Motion& motion) const noexcept;
    double left_at(double distance) const noexcept;

    LoadSpec spec_;
    Shape shape_ = Shape::point;
    Vec3 direction_ = Vec3::UnitZ();  // axis e, direction of the line, or normal of the plane
    bool between_ = false;            // whether the line is given by two regions
    int origin_ = -1;                 // index of the region at p0 or at the start of the line
};

}  // namespace dihaptic::task
