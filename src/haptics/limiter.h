// Limiter is the last stage before a force or torque goes to a device. It keeps the force finite,
// limits its magnitude and its rate of change, and keeps it within the thermal limit of the
// device's motors.
#pragma once

#include "base/status.h"
#include "haptics/heating.h"

namespace dihaptic::haptics {

class Limiter {
  public:
    /// Maximum magnitude [N] and maximum rate of change [N/s]; for a torque, [N*m] and [N*m/s]. A
    /// falling force may change faster, so that it reaches zero within kLongestFall.
    Limiter(double max_force, double max_rate, const Heating& heating = {})
        : max_force_(max_force), max_rate_(max_rate), heating_(heating) {}

    /// Returns the force that may be sent after a tick of h [s], and adds every intervention to
    /// `status`. After a requested force that is not finite, the result is zero until restart().
    Vec3 limit(const Vec3& asked, double h, uint32_t& status) noexcept;
    /// Must be called if zero was sent instead of the last force; the force then rises again from
    /// zero.
    void drop() noexcept { last_.setZero(); }
    bool faulted() const noexcept { return faulted_; }
    /// Restarts after a pause with zero force, but keeps the temperature of the motors.
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
