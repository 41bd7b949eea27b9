// Drives: a drive moves a body along a path while a state lasts, regardless of contact forces.
// Examples are a platform that rises, a plate that shakes, and an object that a partner hands over.
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

/// The path of a body while a state lasts: to a position, by a displacement, or as given by
/// expressions or a table. On paths of the first two kinds, the body can also rotate; it can also
/// rotate in place.
struct DriveSpec {
    Ref<scene::Body> body;
    std::optional<FormulaVec3> to;    ///< final position of the body's origin [m]
    std::optional<FormulaVec3> by;    ///< displacement from the body's initial position [m]
    std::optional<Vec3> axis;         ///< axis of rotation, through the body's origin
    Formula angle = 0;                ///< angle of rotation, right-handed [rad]
    std::optional<Formula> duration;  ///< duration of the motion [s]
    Formula delay = 0;                ///< [s]
    ProfileShape shape = ProfileShape::minimum_jerk;
    std::vector<std::string> along;   ///< expressions for the displacement along x, y and z
    std::optional<SampledPath> path;  ///< table of displacements from the initial position
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        const Field way = Field::length().within(-100, 100);
        const Field time = Field::of(Quantity::time).within(0, 3600);
        v("body", body, Field::text().required().says("Body that moves."));
        v("to", to, way.says("Final position of the body's origin."));
        v("by", by, way.says("Displacement from the body's position when the state begins."));
        v("axis", axis,
          Field::number().within(-1e6, 1e6).says(
              "Axis of rotation through the body's origin; a vector of any length."));
        v("angle", angle,
          Field::of(Quantity::angle)
              .within(-1000, 1000)
              .says("Angle of rotation from the body's orientation when the state begins, "
                    "right-handed."));
        v("duration", duration, time.says("Duration of the motion."));
        v("delay", delay, time.says("Delay from the beginning of the state."));
        v("shape", shape, says("Shape of the motion's time course."));
        v("along", along,
          says("Three expressions with units, evaluated in each tick: displacement along x, y and "
               "z from the body's position when the state began."));
        v("path", path,
          says("Table of displacements from the body's position when the state began."));
    }
};

/// A drive, ready to be evaluated.
class Drive {
  public:
    /// `body` is the body's index in the scene; `quantities` are those that expressions may use.
    Drive(const DriveSpec& spec, int body, Quantities& quantities, Diagnostics& diagnostics);

    int body() const noexcept { return body_; }
    /// Pose of the body at time `t` after the beginning of the state [s]. `from` is the body's pose
    /// at that beginning, `of(Formula)` returns the formula's value in this trial, and `values` are
    /// those of the quantities.
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
    std::vector<Expression> along_;  // one expression for each of x, y and z, or empty
    std::optional<SampledPath> path_;
};

}  // namespace dihaptic::task
