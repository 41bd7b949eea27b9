// The last thing that happens to a force before a device gets it: finite, no larger and changing no
// faster than allowed.
#pragma once

#include "base/geometry.h"

namespace dihaptic::haptics {

/// What the limiter had to do.
enum LimitFlags : unsigned {
    kForceLimited =
        1u << 0,  ///< the magnitude was cut: a softer coupling, or a gentler hand, avoids it
    kRateLimited = 1u << 1,  ///< the change was cut: contact was fast or the coupling is stiff
    kNotFinite =
        1u << 2,  ///< NaN or infinity was asked for: no more force until the session restarts
};

class Limiter {
  public:
    /// Largest magnitude [N] and largest change in magnitude [N/s].
    Limiter(double max_force, double max_rate) : max_force_(max_force), max_rate_(max_rate) {}

    /// The force that may be sent after one tick of h [s]. `flags` gets what had to be done.
    Vec3 limit(const Vec3& asked, double h, unsigned& flags) noexcept;
    bool faulted() const noexcept { return faulted_; }

  private:
    double max_force_;
    double max_rate_;
    Vec3 last_ = Vec3::Zero();
    bool faulted_ = false;
};

}  // namespace dihaptic::haptics
