// What a person sees: where hands and targets are shown, some time ago.
#pragma once

#include <array>

#include "base/random.h"
#include "person/past.h"
#include "servo/displayed.h"

namespace dihaptic::person {

struct Sight {
    int trial = 0;
    int attempt = 0;
    int phase = 0;             ///< which of the task's states it is: its targets, its message
    Vec3 hand = Vec3::Zero();  ///< shown: middle of the fingers [m]
    uint32_t shown = 0;        ///< regions, a bit each
    std::array<Vec3, servo::TaskFrame::kMostTargets> target{};  ///< by region; where shown [m]
};

class Eyes {
  public:
    Eyes(double delay, double tick) : delay_(delay), past_(delay, tick) {}

    void restart() noexcept { past_.clear(); }

    void take(const servo::Frame& frame) noexcept {
        Sight sight;
        sight.trial = frame.trial;
        sight.attempt = frame.task.attempt;
        sight.phase = frame.phase;
        for (size_t i = 0; i < frame.fingers.size(); ++i) {
            sight.hand +=
                servo::displayed_proxy(frame, i).p / static_cast<double>(frame.fingers.size());
        }
        for (size_t i = 0; i < frame.task.targets.size(); ++i) {
            const auto region = static_cast<size_t>(frame.task.targets[i].region);
            sight.shown |= 1u << region;
            sight.target[region] = servo::displayed_target(frame, i);
        }
        past_.add(sight);
    }
    /// What is seen now; not before the first Frame.
    const Sight& sight() const noexcept { return past_.before(delay_); }

  private:
    double delay_;
    Past<Sight> past_;
};

/// A position as somebody judges it who looks once [m].
inline Vec3 look(const Vec3& p, double noise, Random& random) noexcept {
    const Vec3 error(random.normal(), random.normal(), random.normal());
    return p + noise * error;
}

}  // namespace dihaptic::person
