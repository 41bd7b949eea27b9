// Drives: paths on which a state moves a body, whatever presses on it, such as a platform that
// rises, a plate that shakes, or an object that a partner hands over.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/formula.h"
#include "frame/task_frame.h"
#include "scene/scene.h"
#include "task/expression/expression.h"
#include "task/file/profile.h"
#include "task/file/ref.h"
#include "task/file/sampled_path.h"

namespace dihaptic::task {

/// A body's path while a state lasts: to a place, by a way, along expressions, or as a table has
/// it. While it goes to a place or by a way it may turn, or it turns where it is.
struct DriveSpec {
    Ref<scene::Body> body;
    std::optional<FormulaVec3> to;    ///< where its origin ends [m]
    std::optional<FormulaVec3> by;    ///< the way from where it begins [m]
    std::optional<Vec3> axis;         ///< about which it turns, through its origin
    Formula angle = 0;                ///< by which it turns, right-handed [rad]
    std::optional<Formula> duration;  ///< of all of these [s]
    Formula delay = 0;                ///< [s]
    ProfileShape shape = ProfileShape::minimum_jerk;
    std::vector<std::string> along;   ///< the way from where it begins, anew in each tick: x, y, z
    std::optional<SampledPath> path;  ///< the way from where it begins, as a table has it
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        const Field way = Field::length().within(-100, 100);
        const Field time = Field::of(Quantity::time).within(0, 3600);
        v("body", body, Field::text().required().says("Body that moves."));
        v("to", to, way.says("Where its origin ends."));
        v("by", by, way.says("How far it goes from where it is as the state begins."));
        v("axis", axis,
          Field::number().within(-1e6, 1e6).says(
              "Axis through its origin about which it turns meanwhile, of any length."));
        v("angle", angle,
          Field::of(Quantity::angle)
              .within(-1000, 1000)
              .says("By how much it turns from how it is as the state begins, right-handed."));
        v("duration", duration, time.says("How long it takes to go and turn there."));
        v("delay", delay, time.says("How long it waits from the beginning of the state."));
        v("shape", shape, says("How it speeds up and slows down on its way."));
        v("along", along,
          says("Three expressions with units: how far it is along x, y and z from where it was as "
               "the state began, evaluated in each tick."));
        v("path", path, says("The way from where it was as the state began, as a table has it."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// A drive, ready to be evaluated.
class Drive {
  public:
    /// `body`: index in the scene; `quantities`: what expressions may name.
    Drive(const DriveSpec& spec, int body, Quantities& quantities, Diagnostics& diagnostics);

    int body() const noexcept { return body_; }
    /// Where the body is `t` after the beginning of the state [s], in which it began at `from`.
    /// `of(Formula)` is a number in this trial, `values` are those of the quantities.
    template <class Of>
    Pose at(double t, const Pose& from, const Of& of,
            std::span<const double> values) const noexcept {
        Pose out = from;
        if (!along_.empty()) {
            const Vec3 way(along_[0](values), along_[1](values), along_[2](values));
            if (way.allFinite()) out.p += way;
            return out;
        }
        if (path_) {
            out.p += path_->way(t - of(course_.delay));
            return out;
        }
        const double share = course_.share(t, of);
        const Vec3 to_W(of(way_[0]), of(way_[1]), of(way_[2]));
        out.p += share * (relative_ ? to_W : Vec3(to_W - from.p));
        out.R = Quat(Eigen::AngleAxisd(share * of(angle_), axis_)) * from.R;
        return out;
    }

  private:
    int body_;
    bool relative_ = true;
    FormulaVec3 way_{};
    Vec3 axis_ = Vec3::UnitZ();
    Formula angle_{};
    Course course_;
    std::vector<Expression> along_;  // none, or three
    std::optional<SampledPath> path_;
};

}  // namespace dihaptic::task
