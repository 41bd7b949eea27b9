#include "haptics/limiter.h"

#include <algorithm>

#include "frame/haptics_settings.h"

namespace dihaptic::haptics {

Vec3 Limiter::limit(const Vec3& asked, double h, uint32_t& status) noexcept {
    if (!asked.allFinite()) faulted_ = true;
    if (faulted_) {
        // straight to zero: the only case in which force may drop faster than the limit
        status |= kNotFinite;
        last_.setZero();
        return last_;
    }
    Vec3 force = asked;
    if (const double size = force.norm(); size > max_force_) {
        force *= max_force_ / size;
        status |= kForceLimited;
    }
    if (const double size = force.norm(), most = heating_.most_force(); size > most) {
        force *= most / size;
        status |= kHeatLimited;
    }
    const Vec3 change = force - last_;
    const bool falls = force.squaredNorm() < last_.squaredNorm();
    const double most =
        h * (falls ? std::max(max_rate_, max_force_ / frame::kLongestFall) : max_rate_);
    if (const double size = change.norm(); size > most) {
        force = last_ + change * (most / size);
        status |= kRateLimited;
    }
    last_ = force;
    heating_.add(force, h);
    return force;
}

}  // namespace dihaptic::haptics
