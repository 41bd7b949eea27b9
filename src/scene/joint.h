// Describes a joint between two bodies, or between a body and the world, as given in a scene file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "scene/joint_kind.h"
#include "scene/spring_curve.h"

namespace dihaptic::scene {

/// A joint between two bodies, or between a body and the world. Joined bodies do not touch each
/// other, unless `collide` is set or the joint is a distance joint. The joint coordinate is that of
/// the second body relative to the first and is zero at the start; for a distance joint, it is the
/// distance itself.
struct Joint {
    std::string name;
    JointKind kind = JointKind::hinge;
    std::vector<std::string> between;  ///< two bodies, or one that is joined to the world
    /// Name of the body in whose frame the file gives the joint; complete() converts everything to
    /// the world frame.
    std::string in;
    Vec3 position = Vec3::Zero();         ///< initial position of the joint [m]
    Vec3 axis = Vec3::UnitZ();            ///< initial direction of the axis; need not be normalised
    Vec3 second_axis = Vec3::UnitX();     ///< second axis of a universal joint
    std::optional<Vec3> second_position;  ///< for a distance joint: point on the second body [m]
    /// For the free axis of a hinge or slider, or for a distance joint.
    double stiffness = 0;       ///< [N/m] or [N*m/rad]
    SpringCurve curve;          ///< used in place of the stiffness
    double rest = 0;            ///< coordinate at which the spring is relaxed [m] or [rad]
    double damping = 0;         ///< [N*s/m] or [N*m*s/rad]
    double friction = 0;        ///< dry friction [N] or [N*m]
    std::optional<double> low;  ///< lower and upper stops [m] or [rad]
    std::optional<double> high;
    /// For a bushing: the initial orientation of its axes, rotated from the world's axes about x,
    /// then y, then z. The axes move with the first body. An axis without a spring and a damper is
    /// free.
    Vec3 rotation = Vec3::Zero();          ///< [rad]
    Vec3 stiffnesses = Vec3::Zero();       ///< [N/m]
    Vec3 turn_stiffnesses = Vec3::Zero();  ///< [N*m/rad]
    Vec3 dampings = Vec3::Zero();          ///< [N*s/m]
    Vec3 turn_dampings = Vec3::Zero();     ///< [N*m*s/rad]
    bool collide = false;
    bool recorded = true;  ///< whether the joint is recorded, and available to tasks by its name
    Place place;

    const JointKindRow& row() const { return describe(kind); }
    bool is_distance() const { return row().coordinate == Coordinate::distance; }
    bool has_coordinate() const { return row().has_coordinate(); }
    /// Whether the joint has a coordinate that is a length.
    bool slides() const { return has_coordinate() && row().coordinate != Coordinate::angle; }
    /// Whether a distance joint has neither a spring nor limits, which makes it a rod.
    bool is_rod() const { return is_distance() && !has_axis_spring() && !low && !high; }
    /// Whether the joined bodies can touch each other.
    bool lets_touch() const { return collide || row().sliding == Sliding::any; }
    /// Whether a spring acts along the joint coordinate.
    bool has_axis_spring() const { return stiffness > 0 || !curve.is_empty(); }
    bool has_spring() const {
        return has_axis_spring() || !stiffnesses.isZero(0) || !turn_stiffnesses.isZero(0);
    }
    bool has_damper() const {
        return damping > 0 || !dampings.isZero(0) || !turn_dampings.isZero(0);
    }

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the joint."));
        v("kind", kind, Field::text().required().says("The motion that the joint allows."));
        v("between", between,
          Field::text().required().says("Two bodies, or one body joined to the world."));
        v("in", in,
          Field::text().says(
              "Body in whose frame positions and directions are given, which is the frame "
              "of its mesh file; if left out, the world's frame."));
        v("position", position,
          Field::length().within(-100, 100).says("Position of the joint at the start."));
        v("axis", axis,
          Field::number().within(-1e6, 1e6).says(
              "Axis at the start, of any length, of a hinge or slider; for a universal joint, the "
              "axis fixed in the first body."));
        v("second_axis", second_axis,
          Field::number().within(-1e6, 1e6).says(
              "Axis of a universal joint that is fixed in the second body."));
        v("second_position", second_position,
          Field::length().within(-100, 100).says(
              "Initial position of a distance joint's point on the second body."));
        visit_coordinate(v);
        visit_bushing(v);
        v("collide", collide, says("Whether the two bodies can nevertheless touch each other."));
        v("recorded", recorded,
          says("Whether the joint is recorded, so that tasks can use its name."));
    }

    static constexpr double kStiffest = 1e7;  // limit for the joint's springs [N/m] or [N*m/rad]

  private:
    static constexpr double kMostForce = 1e4;
    static constexpr double kMostWay = 1000;
    static constexpr double kMostDamping = 1e5;

    static constexpr Field at_most(Quantity quantity, double most) {
        return Field::of(quantity).within(0, most);
    }
    template <class Visitor>
    void visit_coordinate(Visitor& v) {
        const auto of = [&](Quantity sliding, Quantity turning) {
            return Field::of(slides() ? sliding : turning);
        };
        const Field way = of(Quantity::length, Quantity::angle).within(-kMostWay, kMostWay);
        const Field force = of(Quantity::force, Quantity::torque);
        v("stiffness", stiffness,
          of(Quantity::stiffness, Quantity::turn_stiffness)
              .within(0, kStiffest)
              .says("Stiffness of a spring about a hinge's axis, along a slider's axis, or along a "
                    "distance."));
        v("curve_at", curve.stretch,
          way.says("For a spring that does not obey Hooke's law: stretches from its rest, "
                   "ascending."));
        v("curve", curve.resistance,
          force.within(-kMostForce, kMostForce)
              .says("Resistance at these stretches, with straight lines between them and "
                    "beyond."));
        v("rest", rest,
          way.says("Coordinate at which the spring is relaxed, 0 at the start; for a distance "
                   "joint, the relaxed length."));
        v("damping", damping,
          of(Quantity::damping, Quantity::turn_damping)
              .within(0, kMostDamping)
              .says("Damping parallel to the spring."));
        v("friction", friction,
          force.within(0, kMostForce).says("Dry friction about or along the axis."));
        v("low", low, way.says("Lower stop of the joint coordinate."));
        v("high", high,
          way.says("Upper stop of the joint coordinate; for a distance joint, the length of a "
                   "rope."));
    }
    template <class Visitor>
    void visit_bushing(Visitor& v) {
        v("rotation", rotation,
          Field::of(Quantity::angle)
              .within(-100, 100)
              .says("For a bushing: rotation of its axes from the world's at the start, about x, "
                    "then y, then z."));
        v("stiffnesses", stiffnesses,
          at_most(Quantity::stiffness, kStiffest)
              .says("For a bushing: stiffnesses along its axes x, y and z."));
        v("turn_stiffnesses", turn_stiffnesses,
          at_most(Quantity::turn_stiffness, kStiffest)
              .says("For a bushing: rotational stiffnesses about these axes."));
        v("dampings", dampings,
          at_most(Quantity::damping, kMostDamping)
              .says("For a bushing: dampings along these axes."));
        v("turn_dampings", turn_dampings,
          at_most(Quantity::turn_damping, kMostDamping)
              .says("For a bushing: rotational dampings about these axes."));
    }
};

}  // namespace dihaptic::scene
