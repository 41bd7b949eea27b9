// KnobTurner moves the knobs of a running session toward values requested by another thread.
#pragma once

#include <optional>

#include "base/latest.h"
#include "servo/servo.h"
#include "task/run/clearance.h"

namespace dihaptic::session {

class KnobTurner {
  public:
    /// Called from one thread with the requested knob values; before the first call, the session's
    /// own values apply. Some knobs change gradually, so that a held object stays held. If
    /// settings.proxy.changeable is set, a different kind of proxy can be requested. It is adopted
    /// once all fingers are clear of all bodies, so that no finger drops an object or pushes away a
    /// body that it overlaps. The workspaces turn to the requested angle; the rate at which they
    /// turn is computed from the angle.
    void publish(const frame::Knobs& knobs) { wanted_.publish(knobs); }
    static constexpr double kEase = 0.2;  // [s]

    /// Must be called before the first tick.
    void prepare(const servo::Servo& servo, const scene::Scene& scene);
    /// Called in a tick of length h [s]. Moves `now`, the knobs ordered last, toward the requested
    /// values.
    void turn(const frame::Frame& last, double h, frame::Knobs& now) noexcept;

  private:
    Latest<std::optional<frame::Knobs>> wanted_;
    task::Clearance clearance_;
    bool changeable_ = false;  // whether the kind of proxy may change
    frame::Knobs goal_;        // newest value of wanted_
    double left_ = 0;          // time left until goal_ is reached [s]
};

}  // namespace dihaptic::session
