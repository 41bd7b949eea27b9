// Motors: what a state does to a joint while it lasts, such as a lever that is turned under the
// hand, or a handle that pushes back. A motor takes the joint somewhere, no harder than it can, or
// pushes with a force of its own.
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

/// A joint's course while a state lasts, the force that pushes it, or both.
struct MotorSpec {
    Ref<scene::Joint> joint;
    std::optional<Formula> angle;         ///< where a hinge ends [rad]
    std::optional<Formula> displacement;  ///< where a slider or a distance ends [m]
    std::optional<Formula> duration;      ///< of the way there [s]
    Formula delay = 0;                    ///< [s]
    ProfileShape shape = ProfileShape::minimum_jerk;
    std::string follow;                  ///< where it is to be, anew in each tick
    std::optional<Formula> most_force;   ///< with which it is taken there [N]
    std::optional<Formula> most_torque;  ///< [N*m]
    std::string push;                    ///< force or torque besides, anew in each tick
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        const Field way = Field::length().within(-100, 100);
        const Field time = Field::of(Quantity::time).within(0, 3600);
        v("joint", joint, Field::text().required().says("Joint that the motor moves."));
        v("angle", angle,
          Field::of(Quantity::angle).within(-1000, 1000).says("Where a hinge ends."));
        v("displacement", displacement, way.says("Where a slider or a distance ends."));
        v("duration", duration, time.says("How long it takes to go there."));
        v("delay", delay, time.says("How long it waits from the beginning of the state."));
        v("shape", shape, says("How it speeds up and slows down on its way."));
        v("follow", follow,
          says("An expression with a unit: where the joint is to be, evaluated in each tick."));
        v("most_force", most_force,
          Field::of(Quantity::force)
              .within(0, 1e4)
              .says("The most with which a slider or a distance is moved there."));
        v("most_torque", most_torque,
          Field::of(Quantity::torque)
              .within(0, 1e4)
              .says("The most with which a hinge is turned there."));
        v("push", push,
          says("An expression with a unit: a force, or of a hinge a torque, with which the joint "
               "is pushed besides, evaluated in each tick."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// A motor, ready to be evaluated.
class Motor {
  public:
    /// `index`: of the joint in the scene; `quantities`: what expressions may name.
    Motor(const MotorSpec& spec, const scene::Joint& joint, int index, Quantities& quantities,
          Diagnostics& diagnostics);

    int joint() const noexcept { return joint_; }
    /// What it does `t` after the beginning of the state [s], in which the joint began at `from`.
    /// `of(Formula)` is a number in this trial, `values` are those of the quantities.
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
    /// An expression may divide by what is zero just now.
    static double finite_or(double otherwise, double value) noexcept {
        return std::isfinite(value) ? value : otherwise;
    }

    int joint_;
    bool goes_ = false;  ///< to a place; otherwise it follows an expression, if there is one
    Formula to_{};
    Course course_;
    Formula most_{};
    Expression follow_;
    Expression push_;
};

}  // namespace dihaptic::task
