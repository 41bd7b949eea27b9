// Driver is the interface between the mechanics of the hand and the source of the fingers' targets:
// a script, a recorded movement or the mouse.
#pragma once

#include <string>

#include "base/clock.h"
#include "base/geometry.h"

namespace dihaptic::hand {

/// Equilibrium point of a finger, in world axes.
struct FingerTarget {
    Vec3 p_WT = Vec3::Zero();      ///< [m]
    Vec3 v_WT = Vec3::Zero();      ///< [m/s]
    Quat R_WT = Quat::Identity();  ///< desired orientation of the handle
    Vec3 w_WT = Vec3::Zero();      ///< [rad/s]
};

class Driver {
  public:
    virtual ~Driver() = default;

    /// Returns the finger's target at time t. Called during a tick, so it must not allocate or
    /// throw.
    FingerTarget target(int finger, double t) const noexcept { return do_target(finger, t); }
    /// Time during which the driver moves the fingers [s].
    virtual double duration() const = 0;
    /// A section of the movement, with a name that is used in summaries and trial tables.
    struct Phase {
        std::string name;
        double start = 0;  ///< [s]
        double end = 0;
    };
    virtual const std::vector<Phase>& phases() const = 0;

  private:
    virtual FingerTarget do_target(int finger, double t) const noexcept = 0;
};

}  // namespace dihaptic::hand
