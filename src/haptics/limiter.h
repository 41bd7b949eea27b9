// Limiter is the last step before a force, or a torque, goes to a device: it keeps the force
// finite, no larger and changing no faster than allowed, and within the thermal limit of the
// device's motors.
#pragma once

#include "base/status.h"
#include "haptics/heating.h"

namespace dihaptic::haptics {

class Limiter {
  public:
    /// Largest magnitude [N] and largest change [N/s]; for a torque [N*m], [N*m/s]. A falling force
    /// may change faster, so that it reaches zero within kLongestFall.
    Limiter(double max_force, double max_rate, const Heating& heating = {})
        : max_force_(max_force), max_rate_(max_rate), heating_(heating) {}

    /// The force that may be sent after a tick of h [s]. Adds every intervention to `status`. After
    /// a force that is not finite, the force is zero until restart().
    Vec3 limit(const Vec3& asked, double h, uint32_t& status) noexcept;
    /// Notes that zero was sent instead of the last force: force rises again from there.
    void drop() noexcept { last_.setZero(); }
    bool faulted() const noexcept { return faulted_; }
    /// Starts again after a pause, with force zero, but keeps the motors' temperature.
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
