#include "haptics/force_guard.h"

namespace dihaptic::haptics {

ForceGuard::ForceGuard(const SafetySettings& settings, const DeviceLimits& limits, double tick,
                       const Pose& X_WD)
    : tick_(tick),
      X_WD_(X_WD),
      X_DW_(X_WD.inverse()),
      energy_(settings.energy_guard),
      wall_(limits.workspace, settings.workspace_stiffness, tick),
      limiter_(settings.largest_force(limits.peak_force), settings.max_force_rate,
               Heating(limits.peak_force, limits.continuous_force, settings.heating_time)) {}

Vec3 ForceGuard::shape(const Vec3& f_asked_W, const Handle& handle, const Vec3& p_WP, double stored,
                       bool stepped, unsigned& flags) noexcept {
    const Vec3 damper = energy_.watch(handle, p_WP, f_asked_W, stored, stepped, tick_, flags);
    const Vec3 push_D = wall_.force(X_DW_ * handle.p_WH, X_DW_.R * handle.v_WH);
    if (push_D != Vec3::Zero()) flags |= kPushedInward;
    return f_asked_W + damper + X_WD_.R * push_D;
}

Vec3 ForceGuard::limit(const Vec3& f_H_W, bool allowed, double share, unsigned& flags) noexcept {
    if (allowed && share < 1 && f_H_W != Vec3::Zero()) flags |= kSoftStarted;
    Vec3 limited = limiter_.limit(share * f_H_W, tick_, flags);
    if (allowed) return limited;
    flags |= kSwitchedOff;
    limiter_.drop();
    return Vec3::Zero();
}

}  // namespace dihaptic::haptics
