// The course in time of a perturbation's share within a trial: it waits, rises, stays, and falls.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "base/diagnostics.h"
#include "base/field.h"
#include "base/formula.h"
#include "model/minimum_jerk.h"

namespace dihaptic::task {

/// How a share rises and falls.
enum class ProfileShape { linear, minimum_jerk };
constexpr auto enum_names(ProfileShape) {
    return std::array{"linear", "minimum_jerk"};
}

/// Factors on a perturbation's share, by the time since it began. The default is 1 at all times.
struct Profile {
    double delay = 0;               ///< before it rises [s]
    double rise = 0;                ///< [s]
    std::optional<double> plateau;  ///< unset: it never falls [s]
    double fall = 0;                ///< [s]
    ProfileShape shape = ProfileShape::linear;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        const Field time = Field::of(Quantity::time).within(0, 3600);
        v("delay", delay,
          time.says("How long it waits, from when the first of its states is entered."));
        v("rise", rise, time.says("How long the share rises."));
        v("plateau", plateau,
          time.says("How long it stays; left out, as long as its states last."));
        v("fall", fall, time.says("How long it falls after that."));
        v("shape", shape, says("How it rises and falls."));
        if constexpr (requires { v.place(); }) place = v.place();
    }

    /// The factor at `t` since the beginning [s], from 0 to 1.
    double share(double t) const noexcept {
        constexpr double kRounding = 1e-9;  // times are sums of ticks, which round
        t += kRounding - delay;
        if (t < 0) return 0;
        if (t < rise) return risen(t / rise);
        if (!plateau) return 1;
        t -= rise + *plateau;
        if (t < 0) return 1;
        return t < fall ? 1 - risen(t / fall) : 0;
    }

  private:
    double risen(double s) const noexcept {
        return shape == ProfileShape::linear ? s : model::minimum_jerk(s).share;
    }
};

/// The way from a place to another, as a share of it, in numbers that may be a trial's own.
struct Course {
    Formula delay{};     ///< [s]
    Formula duration{};  ///< [s]
    ProfileShape shape = ProfileShape::minimum_jerk;

    /// The share at `t` since the beginning [s]; `of(Formula)` is a number in this trial.
    template <class Of>
    double share(double t, const Of& of) const noexcept {
        Profile course;
        course.delay = of(delay);
        course.rise = of(duration);
        course.shape = shape;
        return course.share(t);
    }
};

}  // namespace dihaptic::task
