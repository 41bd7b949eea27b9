// Drives: paths on which a state moves a body, whatever presses on it, such as a platform that
// rises, a plate that shakes, or an object that a partner hands over.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/formula.h"
#include "servo/task_frame.h"
#include "task/expression.h"
#include "task/profile.h"

namespace dihaptic::task {

/// A body's path while a state lasts: to a place, by a way, or along expressions.
struct DriveSpec {
    std::string body;
    std::optional<FormulaVec3> to;    ///< where its origin ends [m]
    std::optional<FormulaVec3> by;    ///< the way from where it begins [m]
    std::optional<Formula> duration;  ///< of either [s]
    Formula delay = 0;                ///< [s]
    ProfileShape shape = ProfileShape::minimum_jerk;
    std::vector<std::string> along;  ///< the way from where it begins, anew in each tick: x, y, z
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        const Field way = Field::length().within(-100, 100);
        const Field time = Field::of(Quantity::time).within(0, 3600);
        v("body", body, Field::text().required().says("Body that moves."));
        v("to", to, way.says("Where its origin ends."));
        v("by", by, way.says("How far it goes from where it is as the state begins."));
        v("duration", duration, time.says("How long it takes to go there."));
        v("delay", delay, time.says("How long it waits from the beginning of the state."));
        v("shape", shape, says("How it speeds up and slows down on its way."));
        v("along", along,
          says("Three expressions with units: how far it is along x, y and z from where it was as "
               "the state began, evaluated in each tick."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// A drive, ready to be evaluated.
class Drive {
  public:
    /// `body`: index in the scene; `quantities`: what expressions may name.
    Drive(const DriveSpec& spec, int body, Quantities& quantities, Diagnostics& diagnostics);

    int body() const noexcept { return body_; }
    /// Where the body is `t` after the beginning of the state [s], in which it began at `from_W`.
    /// `of(Number)` is a number in this trial, `values` are those of the quantities.
    template <class Of>
    Vec3 at(double t, const Vec3& from_W, const Of& of,
            std::span<const double> values) const noexcept {
        if (!along_.empty()) {
            const Vec3 way(along_[0](values), along_[1](values), along_[2](values));
            return way.allFinite() ? Vec3(from_W + way) : from_W;
        }
        Profile course;
        course.delay = of(delay_);
        course.rise = of(duration_);
        course.shape = shape_;
        const Vec3 to_W(of(way_[0]), of(way_[1]), of(way_[2]));
        return from_W + course.share(t) * (relative_ ? to_W : Vec3(to_W - from_W));
    }

  private:
    int body_;
    bool relative_ = false;
    std::array<Number, 3> way_{};
    Number duration_{};
    Number delay_{};
    ProfileShape shape_;
    std::vector<Expression> along_;  // none, or three
};

}  // namespace dihaptic::task
