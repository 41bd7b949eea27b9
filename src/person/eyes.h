// A simulated person's sight: the displayed positions of the hand and the targets, one visual delay
// ago.
#pragma once

#include <array>

#include "base/random.h"
#include "frame/displayed.h"
#include "person/past.h"

namespace dihaptic::person {

struct Sight {
    int trial = 0;
    int attempt = 0;
    int phase = 0;             ///< state of the task, recognised by its targets and message
    Vec3 hand = Vec3::Zero();  ///< displayed middle of the fingers [m]
    bool hand_shown = false;   ///< whether at least one finger is displayed
    uint32_t shown = 0;        ///< regions that are shown as targets, one bit per region
    std::array<Vec3, frame::TaskFrame::kMostTargets> target{};  ///< displayed, by region [m]
};

class Eyes {
  public:
    /// `first`: index of the hand's first finger. `fingers`: number of fingers of the hand.
    /// `delay`, `tick`: [s].
    Eyes(double delay, size_t first, size_t fingers, double tick)
        : delay_(delay), first_(first), fingers_(fingers), past_(delay, tick) {}

    void restart() noexcept { past_.clear(); }

    void take(const frame::Frame& frame) noexcept {
        Sight sight;
        sight.trial = frame.trial;
        sight.attempt = frame.task.attempt;
        sight.phase = frame.phase;
        for (size_t i = first_; i < first_ + fingers_; ++i) {
            sight.hand += frame::displayed_proxy(frame, i).p / static_cast<double>(fingers_);
            sight.hand_shown |= frame::is_displayed(frame, frame::proxy_of(frame, i));
        }
        for (size_t i = 0; i < frame.task.targets.size(); ++i) {
            const auto region = static_cast<size_t>(frame.task.targets[i].region);
            sight.shown |= 1u << region;
            sight.target[region] = frame::displayed_target(frame, i);
        }
        past_.add(sight);
    }
    /// What the person sees now, i.e. the scene one visual delay ago. Must not be called before the
    /// first Frame.
    const Sight& sight() const noexcept { return past_.before(delay_); }

  private:
    double delay_;
    size_t first_;
    size_t fingers_;
    Past<Sight> past_;
};

/// A position as perceived in a single look. `noise`: SD per axis [m].
inline Vec3 look(const Vec3& p, double noise, Random& random) noexcept {
    const Vec3 error(random.normal(), random.normal(), random.normal());
    return p + noise * error;
}

}  // namespace dihaptic::person
