// KnobTurner turns the knobs of a running session toward those that another thread asks for.
#pragma once

#include <optional>

#include "base/latest.h"
#include "servo/servo.h"
#include "task/run/clearance.h"

namespace dihaptic::session {

class KnobTurner {
  public:
    /// From one thread: the knobs to reach; until then those of the session stay. Some are eased
    /// toward it, so that what is held stays held. Another kind of proxy is taken, if
    /// settings.proxy.changeable, once all fingers are clear of all bodies, so that no finger lets
    /// go of what it holds or pushes away what it overlaps. The workspaces turn to the angle; the
    /// rate follows from it.
    void publish(const frame::Knobs& knobs) { wanted_.publish(knobs); }
    static constexpr double kEase = 0.2;  // [s]

    /// Call before the first tick.
    void prepare(const servo::Servo& servo, const scene::Scene& scene);
    /// In the tick of h [s]: turns `now`, the knobs ordered last, toward those to reach.
    void turn(const frame::Frame& last, double h, frame::Knobs& now) noexcept;

  private:
    Latest<std::optional<frame::Knobs>> wanted_;
    task::Clearance clearance_;
    bool changeable_ = false;  // the kind of the proxies
    frame::Knobs goal_;        // newest of wanted_
    double left_ = 0;          // time until goal_ is reached [s]
};

}  // namespace dihaptic::session
