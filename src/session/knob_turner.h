// KnobTurner turns the knobs of a running session toward values that another thread requests.
#pragma once

#include <optional>

#include "base/latest.h"
#include "servo/servo.h"
#include "task/run/clearance.h"

namespace dihaptic::session {

class KnobTurner {
  public:
    /// Called from one thread with the knobs to reach; before the first call, the session's own
    /// knobs apply. Some knobs change gradually, so that a held object stays held. A different kind
    /// of proxy, if settings.proxy.changeable, is adopted once all fingers are clear of all bodies,
    /// so that no finger drops an object or pushes away a body that it overlaps. The workspaces
    /// turn to the requested angle; the rate of their turn follows from it.
    void publish(const frame::Knobs& knobs) { wanted_.publish(knobs); }
    static constexpr double kEase = 0.2;  // [s]

    /// Call before the first tick.
    void prepare(const servo::Servo& servo, const scene::Scene& scene);
    /// Called in a tick of length h [s]: turns `now`, the last knobs ordered, toward those to
    /// reach.
    void turn(const frame::Frame& last, double h, frame::Knobs& now) noexcept;

  private:
    Latest<std::optional<frame::Knobs>> wanted_;
    task::Clearance clearance_;
    bool changeable_ = false;  // whether the kind of the proxies may change
    frame::Knobs goal_;        // newest of wanted_
    double left_ = 0;          // time until goal_ is reached [s]
};

}  // namespace dihaptic::session
