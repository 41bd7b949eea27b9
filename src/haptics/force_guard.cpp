#include "haptics/force_guard.h"

namespace dihaptic::haptics {

ForceGuard::ForceGuard(const frame::SafetySettings& settings, const frame::DeviceInfo& device,
                       const std::optional<WorkspaceBox>& box, double tick)
    : tick_(tick),
      energy_(settings.energy_guard, device.scale * device.scale * kEnergyBudget),
      wall_(box, settings.workspace_stiffness, tick),
      limiter_(settings.largest_force(device.peak_force, device.scale),
               settings.max_force_rate * device.scale,
               Heating(device.peak_force, device.continuous_force, settings.heating_time)) {
    if (device.peak_torque <= 0) return;
    torque_limiter_.emplace(
        settings.largest_torque(device.peak_torque), settings.max_torque_rate,
        Heating(device.peak_torque, device.continuous_torque, settings.heating_time));
}

Wrench ForceGuard::shape(const Wrench& asked_W, const frame::Handle& handle, const Pose& X_WP,
                         double stored, bool stepped, uint32_t& status) noexcept {
    const Wrench damper = energy_.watch(handle, X_WP, asked_W, stored, stepped, tick_, status);
    Wrench felt_W{asked_W.force + damper.force, Vec3::Zero()};
    if (torque_limiter_) felt_W.torque = asked_W.torque + damper.torque;
    return felt_W;
}

Vec3 ForceGuard::push(const frame::Handle& handle, uint32_t& status) const noexcept {
    const Vec3 push_W = wall_.force(handle.p_WH, handle.v_WH);
    if (push_W != Vec3::Zero()) status |= kPushedInward;
    return push_W;
}

Wrench ForceGuard::limit(const Wrench& felt, bool allowed, double share,
                         uint32_t& status) noexcept {
    if (allowed && share < 1 && !felt.is_zero()) status |= kSoftStarted;
    Wrench limited{limiter_.limit(share * felt.force, tick_, status), Vec3::Zero()};
    if (torque_limiter_)
        limited.torque = torque_limiter_->limit(share * felt.torque, tick_, status);
    chatter_.add(limited.force, tick_);
    if (allowed) return limited;
    status |= kSwitchedOff;
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
