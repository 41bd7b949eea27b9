// Motors: a motor acts on a joint while a state lasts, e.g. to rotate a lever under the hand or to
// push a handle back. The motor moves the joint along a course with a limited force, applies a
// given force, or both.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>

#include "base/diagnostics.h"
#include "base/formula.h"
#include "frame/task_frame.h"
#include "scene/joint.h"
#include "task/expression/expression.h"
#include "task/file/profile.h"
#include "task/file/ref.h"

namespace dihaptic::task {

/// The course of a joint while a state lasts, the force applied to the joint, or both.
struct MotorSpec {
    Ref<scene::Joint> joint;
    std::optional<Formula> angle;         ///< final angle of a hinge [rad]
    std::optional<Formula> displacement;  ///< final displacement of any other joint [m]
    std::optional<Formula> duration;      ///< duration of the motion [s]
    Formula delay = 0;                    ///< [s]
    ProfileShape shape = ProfileShape::minimum_jerk;
    std::string follow;  ///< expression for the target coordinate, evaluated in each tick
    std::optional<Formula> most_force;   ///< limit of the force that moves the joint [N]
    std::optional<Formula> most_torque;  ///< [N*m]
    std::string push;  ///< expression for an additional force or torque, evaluated in each tick
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        const Field way = Field::length().within(-100, 100);
        const Field time = Field::of(Quantity::time).within(0, 3600);
        v("joint", joint, Field::text().required().says("Joint that the motor moves."));
        v("angle", angle,
          Field::of(Quantity::angle).within(-1000, 1000).says("Final angle of a hinge."));
        v("displacement", displacement,
          way.says("Final displacement of a slider or a distance joint."));
        v("duration", duration, time.says("Duration of the motion."));
        v("delay", delay, time.says("Delay from the beginning of the state."));
        v("shape", shape, says("Shape of the motion's time course."));
        v("follow", follow,
          says("Target coordinate of the joint: an expression with a unit, evaluated in each "
               "tick."));
        v("most_force", most_force,
          Field::of(Quantity::force)
              .within(0, 1e4)
              .says("Largest force with which a slider or a distance joint is moved."));
        v("most_torque", most_torque,
          Field::of(Quantity::torque)
              .within(0, 1e4)
              .says("Largest torque with which a hinge is rotated."));
        v("push", push,
          says("Additional force, or torque on a hinge: an expression with a unit, evaluated in "
               "each tick."));
    }
};

/// A motor, ready to be evaluated.
class Motor {
  public:
    /// `index` is the joint's index in the scene; `quantities` are those that expressions may use.
    Motor(const MotorSpec& spec, const scene::Joint& joint, int index, Quantities& quantities,
          Diagnostics& diagnostics);

    int joint() const noexcept { return joint_; }
    /// Command of the motor at time `t` after the beginning of the state [s]. `from` is the joint's
    /// coordinate at that beginning, `of(Formula)` returns the formula's value in this trial, and
    /// `values` are those of the quantities.
    template <class Of>
    frame::MotorFrame at(double t, double from, const Of& of,
                         std::span<const double> values) const noexcept {
        frame::MotorFrame out;
        out.joint = joint_;
        if (!push_.empty()) out.push = finite_or(0, push_(values));
        if (!goes_ && follow_.empty()) return out;
        out.follows = 1;
        out.most_force = of(most_);
        if (goes_) {
            out.position = from + course_.share(t, of) * (of(to_) - from);
        } else {
            out.position = finite_or(from, follow_(values));
        }
        return out;
    }

  private:
    /// Returns `value` or, if an expression has divided by zero, `otherwise`.
    static double finite_or(double otherwise, double value) noexcept {
        return std::isfinite(value) ? value : otherwise;
    }

    int joint_;
    /// Whether the motor has a destination; if not, it follows follow_, if set.
    bool goes_ = false;
    Formula to_{};
    Course course_;
    Formula most_{};
    Expression follow_;
    Expression push_;
};

}  // namespace dihaptic::task
