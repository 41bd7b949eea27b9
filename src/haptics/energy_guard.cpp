#include "haptics/energy_guard.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::haptics {

Vec3 EnergyGuard::watch(const Handle& handle, const Vec3& p_WP, const Vec3& f_H_W, double stored,
                        bool stepped, double h, unsigned& flags) noexcept {
    if (mode_ == EnergyGuardMode::off || !f_H_W.allFinite()) return Vec3::Zero();
    if (f_H_W == Vec3::Zero()) stored = 0;
    if (stepped) {
        generated_ = std::max(0.0, generated_ + since_step_);
        since_step_ = 0;
    }
    if (started_) {
        const bool was_slack = f_H_W_ == Vec3::Zero();
        double change = stored - stored_ + (f_H_W_ + damper_).dot(handle.p_WH - p_WH_);
        // a proxy that comes to touch was moved by nobody's work until then
        if (!was_slack) change -= f_H_W.dot(p_WP - p_WP_);
        since_step_ += change;
        generated_ *= std::exp(-h / kEnergyWindow);
    }
    started_ = true;
    p_WH_ = handle.p_WH;
    p_WP_ = p_WP;
    f_H_W_ = f_H_W;
    stored_ = stored;
    damper_.setZero();
    const double excess = generated_ - kEnergyBudget;
    if (excess <= 0) return damper_;
    flags |= kEnergyGenerated;
    const double speed2 = handle.v_WH.squaredNorm();
    if (mode_ == EnergyGuardMode::act && speed2 > 0) {
        flags |= kEnergyDamped;
        damper_ = -std::min(kMostEnergyDamping, excess / (h * speed2)) * handle.v_WH;
    }
    return damper_;
}

}  // namespace dihaptic::haptics
