// The last thing that happens to a force before a device gets it, and to a torque: finite, no
// larger and changing no faster than allowed, by the device's motors too.
#pragma once

#include "haptics/heating.h"

namespace dihaptic::haptics {

/// What the limiter had to do.
enum LimitFlags : unsigned {
    kForceLimited =
        1u << 0,  ///< the magnitude was cut: a softer coupling, or a gentler hand, avoids it
    kRateLimited = 1u << 1,  ///< the change was cut: contact was fast or the coupling is stiff
    kNotFinite =
        1u << 2,  ///< NaN or infinity was asked for: no more force until the session goes on
    kHeatLimited = 1u << 3,  ///< the magnitude was cut to what the motors can bear by now
};

class Limiter {
  public:
    /// Largest magnitude [N] and largest change [N/s]; of a torque [N*m], [N*m/s]. A force that
    /// falls may change faster, so that it is gone within kLongestFall.
    Limiter(double max_force, double max_rate, const Heating& heating = {})
        : max_force_(max_force), max_rate_(max_rate), heating_(heating) {}

    /// The force that may be sent after one tick of h [s]. `flags` gets what had to be done.
    Vec3 limit(const Vec3& asked, double h, unsigned& flags) noexcept;
    /// Zero was sent in place of the last force: it rises again from there.
    void drop() noexcept { last_.setZero(); }
    bool faulted() const noexcept { return faulted_; }
    /// As new, but for the warmth of the motors: after a pause force begins at zero.
    void restart() noexcept {
        drop();
        faulted_ = false;
    }

  private:
    double max_force_;
    double max_rate_;
    Heating heating_;
    Vec3 last_ = Vec3::Zero();
    bool faulted_ = false;
};

}  // namespace dihaptic::haptics
