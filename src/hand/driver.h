// What moves the simulated fingers: the seam between the hand's mechanics and whoever decides where
// its fingers want to be (a script, a recorded movement).
#pragma once

#include <string>

#include "base/clock.h"
#include "base/geometry.h"

namespace dihaptic::hand {

/// Equilibrium point of a finger, in world axes.
struct FingerTarget {
    Vec3 p_WT = Vec3::Zero();      ///< [m]
    Vec3 v_WT = Vec3::Zero();      ///< [m/s]
    Quat R_WT = Quat::Identity();  ///< how it wants its handle turned
    Vec3 w_WT = Vec3::Zero();      ///< [rad/s]
};

class Driver {
  public:
    virtual ~Driver() = default;

    /// Where the finger wants to be. Called in the tick: neither allocates nor throws.
    FingerTarget target(int finger, double t) const noexcept { return do_target(finger, t); }
    /// How long the driver has something to do [s].
    virtual double duration() const = 0;
    /// The stretches that the movement is made of, in order: for summaries and trial tables.
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
