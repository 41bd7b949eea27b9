// Loads: forces and torques on handles and bodies that depend on where these are and how they move.
//
//     constant   f = f0,  t = t0
//     viscous    f = -b v
//     curl       f = b e x v
//     general    f = f0 + A (p - p0) + B v
//     spring     f = -k d - b v_d
//     channel    the same, with k > 0
//
// p and v belong to the handle, or to the body; d leads to p from the nearest place of a point,
// line or plane, and v_d is the part of v that changes it. Beyond a zone around p0, or around the
// point, line or plane, a load fades to zero: its factor falls linearly with the distance.
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

enum class LoadKind { constant, viscous, curl, general, spring, channel };
constexpr auto enum_names(LoadKind) {
    return std::array{"constant", "viscous", "curl", "general", "spring", "channel"};
}

/// A load as an experiment file describes it. A key that its kind has no use for is unknown.
struct LoadSpec {
    using Effect = Load;

    LoadKind kind = LoadKind::viscous;
    Refs<Thing> on;
    FormulaVec3 force;           ///< f0 [N]
    FormulaVec3 torque;          ///< t0 [N*m]
    Formula damping = 0;         ///< b [N*s/m]
    Formula stiffness = 0;       ///< k; a negative one drives away [N/m]
    Mat3 A = Mat3::Zero();       ///< [N/m]
    Mat3 B = Mat3::Zero();       ///< [N*s/m]
    Ref<Region> about;           ///< p0, or a point of the line or plane
    std::optional<Vec3> axis;    ///< e of a curl; direction of a spring's line
    std::optional<Vec3> normal;  ///< of a plane
    Ref<Region> from;            ///< on the line
    Ref<Region> to;              ///< on the line
    std::optional<Vec3> free;    ///< direction that, with the line, spans a plane
    bool one_sided = false;      ///< a plane acts only behind it, where its normal points from
    std::optional<double> zone;  ///< distance at which the load begins to fade [m]
    double fade = 0.01;          ///< distance within which it fades [m]
    Formula delay = 0;           ///< age of the p and v that feed the load [s]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind, Field::text().required().says("Law of the load."));
        v("on", on,
          Field::text().required().says("Fingers, whose handles it acts on, and bodies."));
        switch (kind) {
            case LoadKind::constant:
                visit_force(v);
                v("torque", torque,
                  Field::of(Quantity::torque)
                      .within(-10, 10)
                      .says("Torque, on bodies and on handles of devices that render torque."));
                break;
            case LoadKind::viscous:
                visit_damping(v);
                break;
            case LoadKind::curl:
                visit_damping(v);
                v("axis", axis, direction().says("Axis of the field, right-handed."));
                break;
            case LoadKind::general:
                v("A", A,
                  Field::of(Quantity::stiffness)
                      .within(-1e5, 1e5)
                      .says("Matrix by which the force follows the position relative to the "
                            "region's centre."));
                v("B", B,
                  Field::of(Quantity::damping)
                      .within(-1000, 1000)
                      .says("Matrix by which the force follows the velocity."));
                visit_force(v);
                v("about", about, says("Region whose centre is p0."));
                visit_zone(v, "safe_within");
                break;
            case LoadKind::spring:
                v("stiffness", stiffness,
                  Field::of(Quantity::stiffness)
                      .within(-1e5, 1e5)
                      .says("Stiffness; a negative one drives away."));
                visit_place(v);
                v("axis", axis, direction().says("Direction of a line through the region."));
                v("one_sided", one_sided,
                  says("Whether a plane acts only behind it, where its normal points from."));
                visit_zone(v, "safe_within");
                break;
            case LoadKind::channel:
                v("stiffness", stiffness,
                  Field::of(Quantity::stiffness).within(0, 1e5).says("Stiffness."));
                visit_place(v);
                visit_zone(v, "break_out");
                break;
        }
        if (kind != LoadKind::constant)
            v("delay", delay,
              Field::of(Quantity::time)
                  .within(0, 2)
                  .says("Age of the position and velocity that feed the load."));
        if constexpr (requires { v.place(); }) place = v.place();
    }

    /// Whether it is a field whose force follows the velocity alone, or among others.
    bool pushes_by_velocity() const;

  private:
    static constexpr Field direction() { return Field::number().within(-1000, 1000); }
    template <class Visitor>
    void visit_force(Visitor& v) {
        v("force", force,
          Field::of(Quantity::force)
              .within(-1000, 1000)
              .says("Force that does not depend on position and velocity."));
    }
    template <class Visitor>
    void visit_damping(Visitor& v) {
        v("damping", damping,
          Field::of(Quantity::damping)
              .within(-1000, 1000)
              .says("Damping; a negative one drives on."));
    }
    template <class Visitor>
    void visit_place(Visitor& v) {
        visit_damping(v);
        v("about", about, says("Region whose centre is the point, or lies on the line or plane."));
        v("normal", normal, direction().says("Normal of a plane through the region."));
        v("from", from, says("Region that a line leads from."));
        v("to", to, says("Region that it leads to."));
        v("free", free, direction().says("Direction that, with the line, spans a plane."));
    }
    template <class Visitor>
    void visit_zone(Visitor& v, const char* name) {
        v(name, zone,
          Field::length().positive().at_most(10).says(
              "Distance beyond which the load fades; left out, it does not."));
        v("fade", fade,
          Field::length().within(1e-4, 10).says("Distance within which it fades to zero."));
    }
};

/// Adds the load's kind and size, as a report states it.
void say(const LoadSpec& spec, std::vector<std::string>& out);

/// A load with its names looked up. In the tick it neither allocates nor throws.
class Load {
  public:
    /// Problems with the spec go to `diagnostics`.
    Load(const LoadSpec& spec, const Names& names, const scene::Scene& scene,
         Diagnostics& diagnostics);

    const LoadSpec& spec() const { return spec_; }
    /// Whether any of its numbers is a formula.
    bool is_computed() const;
    double stiffness() const { return spec_.stiffness.value; }
    double delay() const { return spec_.delay.value; }
    /// The most that its delay may be [s].
    double longest_delay() const;
    /// What it acts on: indices of bodies; fingers come after the scene's bodies.
    std::span<const int> on() const { return spec_.on.indices; }
    void order(double share, std::span<const Vec3> regions_W, const Motions& motions,
               frame::TaskFrame& out) const noexcept;
    template <class Visitor>
    void visit(Visitor& v) {
        spec_.visit(v);
    }
    /// What it does to a thing with this motion. `regions_W`: centres of the regions [m].
    Wrench act(double share, std::span<const Vec3> regions_W, const Motion& motion) const noexcept;
    /// Its force over velocity, at share 1 [N*s/m]; of channels and springs zero.
    Mat3 velocity_gain() const;
    /// Axis of a curl field; otherwise unset.
    std::optional<Vec3> axis() const;

    /// The most that it may ask of a loop: norms of the matrices by which its force follows
    /// position and velocity, and the force and torque that it reaches.
    struct Demand {
        double stiffness = 0;  ///< including that of its fading [N/m]
        double damping = 0;    ///< [N*s/m]
        double driving = 0;    ///< largest damping with which it drives motion on [N*s/m]
        double force = 0;      ///< at rest; infinite where it grows with the distance [N]
        double torque = 0;     ///< [N*m]
        bool holds = false;    ///< it keeps a hand where it is, and may be as hard as it can
        bool springs = false;  ///< its force is as large as the way, not the speed
    };
    Demand demand() const;

  private:
    enum class Shape { point, line, plane };
    void check_things(const Names& names, const scene::Scene& scene,
                      Diagnostics& diagnostics) const;
    void look_up_place(const Names& names, Diagnostics& diagnostics);
    void check_spring(Diagnostics& diagnostics) const;
    void check_general(Diagnostics& diagnostics);
    Vec3 pull(double share, std::span<const Vec3> regions_W, const Motion& motion) const noexcept;
    double left_at(double distance) const noexcept;

    LoadSpec spec_;
    Shape shape_ = Shape::point;
    Vec3 direction_ = Vec3::UnitZ();  // of e, of a line about a region, or a plane's normal
    bool between_ = false;            // the line leads from one region to another
    int origin_ = -1;                 // region of p0, or where the line begins
};

}  // namespace dihaptic::task
