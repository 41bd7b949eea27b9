// Limiter is the last step before a force, or a torque, goes to a device: it keeps the force
// finite, no larger and changing no faster than allowed, and within what the device's motors can
// bear.
#pragma once

#include "haptics/heating.h"

namespace dihaptic::haptics {

/// What the limiter had to do.
enum LimitFlags : unsigned {
    kForceLimited =
        1u << 0,  ///< the magnitude was cut; a softer coupling or a gentler hand avoids it
    kRateLimited = 1u << 1,  ///< the change was cut: contact was fast or the coupling is stiff
    kNotFinite = 1u << 2,    ///< NaN or infinity was asked for: no force until the session goes on
    kHeatLimited = 1u << 3,  ///< the magnitude was cut to what the motors can bear by now
};

class Limiter {
  public:
    /// Largest magnitude [N] and largest change [N/s]; for a torque [N*m], [N*m/s]. A falling force
    /// may change faster, so that it is gone within kLongestFall.
    Limiter(double max_force, double max_rate, const Heating& heating = {})
        : max_force_(max_force), max_rate_(max_rate), heating_(heating) {}

    /// The force that may be sent after a tick of h [s]. Sets `flags` to what had to be done.
    Vec3 limit(const Vec3& asked, double h, unsigned& flags) noexcept;
    /// Notes that zero was sent instead of the last force: force rises again from there.
    void drop() noexcept { last_.setZero(); }
    bool faulted() const noexcept { return faulted_; }
    /// Begins anew after a pause, with force zero, but keeps the motors' temperature.
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
