// Describes a joint between two bodies, or between a body and the world, as a scene file has it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "scene/spring_curve.h"

namespace dihaptic::scene {

/// What a joint leaves free: to turn about its axis; to slide along it; to turn about its point; to
/// turn about its axis, which the first body has, and its second one, which the second body has;
/// nothing; all but the distance of a point of the first body from one of the second; everything,
/// against springs and dampers.
enum class JointKind { hinge, slider, ball, universal, fixed, distance, bushing };
constexpr auto enum_names(JointKind) {
    return std::array{"hinge", "slider", "ball", "universal", "fixed", "distance", "bushing"};
}

/// Bodies that are joined do not touch each other, unless `collide` is set or the joint is a
/// distance. The joint coordinate is that of the second body relative to the first, zero at the
/// start; the coordinate of a distance is the distance itself.
struct Joint {
    std::string name;
    JointKind kind = JointKind::hinge;
    std::vector<std::string> between;     ///< two bodies, or one that is joined to the world
    std::string in;                       ///< of a file; complete() puts all in the world's frame
    Vec3 position = Vec3::Zero();         ///< of the joint's point at the start [m]
    Vec3 axis = Vec3::UnitZ();            ///< at the start, of any length
    Vec3 second_axis = Vec3::UnitX();     ///< of a universal joint
    std::optional<Vec3> second_position;  ///< of a distance: its point of the second body [m]
    /// Of the free axis of a hinge or slider, or of a distance.
    double stiffness = 0;       ///< [N/m] or [N*m/rad]
    SpringCurve curve;          ///< in place of the stiffness
    double rest = 0;            ///< coordinate at which the spring is relaxed [m] or [rad]
    double damping = 0;         ///< [N*s/m] or [N*m*s/rad]
    double friction = 0;        ///< dry [N] or [N*m]
    std::optional<double> low;  ///< stops [m] or [rad]
    std::optional<double> high;
    /// For a bushing: its axes at the start, turned from the world's about x, then y, then z; the
    /// first body carries them along. An axis without a spring and a damper is free.
    Vec3 rotation = Vec3::Zero();          ///< [rad]
    Vec3 stiffnesses = Vec3::Zero();       ///< [N/m]
    Vec3 turn_stiffnesses = Vec3::Zero();  ///< [N*m/rad]
    Vec3 dampings = Vec3::Zero();          ///< [N*s/m]
    Vec3 turn_dampings = Vec3::Zero();     ///< [N*m*s/rad]
    bool collide = false;
    bool recorded = true;  ///< and known to tasks by its name
    Place place;

    bool is_distance() const { return kind == JointKind::distance; }
    bool is_bushing() const { return kind == JointKind::bushing; }
    /// Whether a spring acts along its coordinate.
    bool has_axis_spring() const { return stiffness > 0 || !curve.is_empty(); }
    bool has_spring() const {
        return has_axis_spring() || !stiffnesses.isZero(0) || !turn_stiffnesses.isZero(0);
    }
    bool has_damper() const {
        return damping > 0 || !dampings.isZero(0) || !turn_dampings.isZero(0);
    }
    /// Whether its coordinate, if it has one, is a length.
    bool slides() const { return kind == JointKind::slider || is_distance(); }
    /// Whether it has a coordinate: a free axis, or a distance.
    bool has_coordinate() const { return kind == JointKind::hinge || slides(); }
    /// Whether nothing limits how far apart the points of a distance may be: it is then a rod.
    bool is_rod() const { return is_distance() && !has_axis_spring() && !low && !high; }

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the joint."));
        v("kind", kind, Field::text().required().says("What the joint leaves free."));
        v("between", between,
          Field::text().required().says("Two bodies, or one that is joined to the world."));
        v("in", in,
          Field::text().says("Body in whose frame its places and directions are given, which is "
                             "that of its mesh's file; left out, the world's."));
        v("position", position,
          Field::length().within(-100, 100).says("Where the joint is at the start."));
        v("axis", axis,
          Field::number().within(-1e6, 1e6).says(
              "Axis at the start, of any length: of a hinge or slider, or the one that the first "
              "body of a universal joint has."));
        v("second_axis", second_axis,
          Field::number().within(-1e6, 1e6).says(
              "Axis of a universal joint that the second body has."));
        v("second_position", second_position,
          Field::length().within(-100, 100).says(
              "Where the second body's point of a distance is at the start."));
        visit_spring(v);
        v("low", low,
          Field::of(slides() ? Quantity::length : Quantity::angle)
              .within(-kMostWay, kMostWay)
              .says("Stop below which the coordinate does not go."));
        v("high", high,
          Field::of(slides() ? Quantity::length : Quantity::angle)
              .within(-kMostWay, kMostWay)
              .says("Stop above which the coordinate does not go; of a distance, the length of a "
                    "rope."));
        visit_bushing(v);
        v("collide", collide, says("Whether the two bodies touch each other all the same."));
        v("recorded", recorded,
          says("Whether what it does is recorded, so that tasks may name it."));
        if constexpr (requires { v.place(); }) place = v.place();
    }

    static constexpr double kStiffest = 1e7;  // of its springs [N/m] or [N*m/rad]

  private:
    static constexpr double kMostForce = 1e4;
    static constexpr double kMostWay = 1000;
    static constexpr double kMostDamping = 1e5;

    template <class Visitor>
    void visit_spring(Visitor& v) {
        v("stiffness", stiffness,
          Field::of(slides() ? Quantity::stiffness : Quantity::turn_stiffness)
              .within(0, kStiffest)
              .says("Of a spring about the axis of a hinge, along that of a slider, or along a "
                    "distance."));
        v("curve_at", curve.stretch,
          Field::of(slides() ? Quantity::length : Quantity::angle)
              .within(-kMostWay, kMostWay)
              .says("Of a spring that does not obey Hooke's law: stretches from its rest, "
                    "ascending."));
        v("curve", curve.resistance,
          Field::of(slides() ? Quantity::force : Quantity::torque)
              .within(-kMostForce, kMostForce)
              .says("With what it resists at these stretches, with straight lines between them and "
                    "beyond."));
        v("rest", rest,
          Field::of(slides() ? Quantity::length : Quantity::angle)
              .within(-kMostWay, kMostWay)
              .says("Coordinate at which the spring is relaxed, 0 at the start; of a distance, its "
                    "length then."));
        v("damping", damping,
          Field::of(slides() ? Quantity::damping : Quantity::turn_damping)
              .within(0, kMostDamping)
              .says("Of a damper beside the spring."));
        v("friction", friction,
          Field::of(slides() ? Quantity::force : Quantity::torque)
              .within(0, kMostForce)
              .says("Dry friction about the axis, or along it."));
    }
    template <class Visitor>
    void visit_bushing(Visitor& v) {
        v("rotation", rotation,
          Field::of(Quantity::angle)
              .within(-100, 100)
              .says("Of a bushing: how its axes are turned from the world's at the start, about x, "
                    "then y, then z."));
        v("stiffnesses", stiffnesses,
          Field::of(Quantity::stiffness)
              .within(0, kStiffest)
              .says("Of a bushing, along its axes x, y and z."));
        v("turn_stiffnesses", turn_stiffnesses,
          Field::of(Quantity::turn_stiffness)
              .within(0, kStiffest)
              .says("Of a bushing, about these axes."));
        v("dampings", dampings,
          Field::of(Quantity::damping)
              .within(0, kMostDamping)
              .says("Of a bushing's dampers, along these axes."));
        v("turn_dampings", turn_dampings,
          Field::of(Quantity::turn_damping)
              .within(0, kMostDamping)
              .says("Of a bushing's dampers, about these axes."));
    }
};

}  // namespace dihaptic::scene
