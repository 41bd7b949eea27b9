#include "haptics/limiter.h"

namespace dihaptic::haptics {

Vec3 Limiter::limit(const Vec3& asked, double h, unsigned& flags) noexcept {
    if (!asked.allFinite()) faulted_ = true;
    if (faulted_) {
        // straight to zero: a fault is the one case in which force may drop faster than the limit
        flags |= kNotFinite;
        last_.setZero();
        return last_;
    }
    Vec3 force = asked;
    if (const double size = force.norm(); size > max_force_) {
        force *= max_force_ / size;
        flags |= kForceLimited;
    }
    if (const double size = force.norm(), most = heating_.most_force(); size > most) {
        force *= most / size;
        flags |= kHeatLimited;
    }
    const Vec3 change = force - last_;
    if (const double size = change.norm(); size > max_rate_ * h) {
        force = last_ + change * (max_rate_ * h / size);
        flags |= kRateLimited;
    }
    last_ = force;
    heating_.add(force, h);
    return force;
}

}  // namespace dihaptic::haptics
