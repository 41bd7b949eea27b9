// The time course of a perturbation's share within a trial: delay, rise, plateau and fall.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "base/diagnostics.h"
#include "base/field.h"
#include "base/formula.h"
#include "model/minimum_jerk.h"

namespace dihaptic::task {

/// Shape of the rise and fall of a share.
enum class ProfileShape { linear, minimum_jerk };
constexpr auto enum_names(ProfileShape) {
    return std::array{"linear", "minimum_jerk"};
}

/// Factor on a perturbation's share as a function of the time since its onset. The default is 1 at
/// all times.
struct Profile {
    Formula delay = 0;  ///< time before the rise [s]
    Formula rise = 0;   ///< [s]
    /// Duration of the plateau; if unset, the share does not fall [s].
    std::optional<Formula> plateau;
    Formula fall = 0;  ///< [s]
    ProfileShape shape = ProfileShape::linear;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        const Field time = Field::of(Quantity::time).within(0, 3600);
        v("delay", delay,
          time.says("Delay from entry into the first of the perturbation's states."));
        v("rise", rise, time.says("Duration of the rise."));
        v("plateau", plateau,
          time.says(
              "Duration of the plateau; if omitted, as long as the perturbation's states last."));
        v("fall", fall, time.says("Duration of the fall after the plateau."));
        v("shape", shape, says("Shape of the rise and the fall."));
    }

    /// The factor at time `t` after the onset [s], from 0 to 1.
    double share(double t) const noexcept {
        // tolerance for rounding errors, since times are sums of ticks
        constexpr double kRounding = 1e-9;
        t += kRounding - delay.value;
        if (t < 0) return 0;
        if (t < rise.value) return risen(t / rise.value);
        if (!plateau) return 1;
        t -= rise.value + plateau->value;
        if (t < 0) return 1;
        return t < fall.value ? 1 - risen(t / fall.value) : 0;
    }

  private:
    double risen(double s) const noexcept {
        return shape == ProfileShape::linear ? s : model::minimum_jerk(s).share;
    }
};

/// Progress of a motion along its path, as a share from 0 to 1. The numbers may differ between
/// trials.
struct Course {
    Formula delay{};     ///< [s]
    Formula duration{};  ///< [s]
    ProfileShape shape = ProfileShape::minimum_jerk;

    /// Returns the share at time `t` after the beginning of the motion [s]. `of(Formula)` returns
    /// the formula's value in this trial.
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
