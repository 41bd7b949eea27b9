#include "haptics/force_guard.h"

namespace dihaptic::haptics {

ForceGuard::ForceGuard(const SafetySettings& settings, const DeviceLimits& limits, double tick)
    : tick_(tick),
      energy_(settings.energy_guard, limits.scale * limits.scale * kEnergyBudget),
      wall_(limits.workspace, settings.workspace_stiffness, tick),
      limiter_(settings.largest_force(limits.peak_force, limits.scale),
               settings.max_force_rate * limits.scale,
               Heating(limits.peak_force, limits.continuous_force, settings.heating_time)) {
    if (limits.peak_torque <= 0) return;
    torque_limiter_.emplace(
        settings.largest_torque(limits.peak_torque), settings.max_torque_rate,
        Heating(limits.peak_torque, limits.continuous_torque, settings.heating_time));
}

Wrench ForceGuard::shape(const Wrench& asked_W, const Handle& handle, const Pose& X_WP,
                         double stored, bool stepped, unsigned& flags) noexcept {
    const Wrench damper = energy_.watch(handle, X_WP, asked_W, stored, stepped, tick_, flags);
    Wrench felt_W{asked_W.force + damper.force, Vec3::Zero()};
    if (torque_limiter_) felt_W.torque = asked_W.torque + damper.torque;
    return felt_W;
}

Vec3 ForceGuard::push(const Handle& handle, unsigned& flags) const noexcept {
    const Vec3 push_W = wall_.force(handle.p_WH, handle.v_WH);
    if (push_W != Vec3::Zero()) flags |= kPushedInward;
    return push_W;
}

Wrench ForceGuard::limit(const Wrench& felt, bool allowed, double share, unsigned& flags) noexcept {
    if (allowed && share < 1 && !felt.is_zero()) flags |= kSoftStarted;
    Wrench limited{limiter_.limit(share * felt.force, tick_, flags), Vec3::Zero()};
    if (torque_limiter_) limited.torque = torque_limiter_->limit(share * felt.torque, tick_, flags);
    chatter_.add(limited.force, tick_);
    if (allowed) return limited;
    flags |= kSwitchedOff;
    drop();
    return {};
}

void ForceGuard::drop() noexcept {
    limiter_.drop();
    if (torque_limiter_) torque_limiter_->drop();
}

void ForceGuard::restart() noexcept {
    limiter_.restart();
    if (torque_limiter_) torque_limiter_->restart();
    energy_.restart();
    chatter_ = {};
}

}  // namespace dihaptic::haptics
