#include "haptics/energy_guard.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::haptics {
namespace {

/// Work of a constant torque while a body turns from A to B [J].
double work(const Vec3& torque_W, const Quat& R_WA, const Quat& R_WB) noexcept {
    if (torque_W == Vec3::Zero()) return 0;
    return torque_W.dot(rotation_vector(R_WB * R_WA.conjugate()));
}

/// Work of a constant force and torque while a body moves from A to B [J].
double work(const Wrench& on_it_W, const Pose& X_WA, const Pose& X_WB) noexcept {
    return on_it_W.force.dot(X_WB.p - X_WA.p) + work(on_it_W.torque, X_WA.R, X_WB.R);
}

/// Force against a velocity (or torque against an angular velocity) that absorbs excess energy
/// within h, like a damper no stronger than `strongest`.
Vec3 braking(const Vec3& velocity, double excess, double h, double strongest) noexcept {
    const double speed2 = velocity.squaredNorm();
    if (!(speed2 > 0)) return Vec3::Zero();
    return -std::min(strongest, excess / (h * speed2)) * velocity;
}

}  // namespace

/// Ends a window at the first step of the world after kActiveWindow, since energy is checked only
/// at steps.
void EnergyGuard::count_windows(bool stepped, double h) noexcept {
    window_ += h;
    if (!stepped || window_ < kActiveWindow) return;
    const double generated = *std::min_element(in_window_.begin(), in_window_.end());
    const bool over = generated > budget_;
    windows_ = over ? windows_ + 1 : 0;
    fed_ = over ? fed_ + generated : 0;
    in_window_ = {};
    window_ = 0;
}

Wrench EnergyGuard::watch(const frame::Handle& handle, const Pose& X_WP, const Wrench& asked_W,
                          double stored, bool stepped, double h, uint32_t& status) noexcept {
    const bool finite = asked_W.force.allFinite() && asked_W.torque.allFinite();
    if (!finite) return {};
    const double to_hand = (asked_.force + damper_.force).dot(handle.p_WH - X_WH_.p) +
                           work(asked_.torque + damper_.torque, X_WH_.R, handle.R_WH);
    const bool slack = asked_W.is_zero();
    // an inactive coupling gets no energy; while stretched, it keeps the energy that it did not
    // release
    if (slack) stored = std::clamp(stored_ - to_hand, 0.0, stored);
    if (stepped) {
        for (size_t i = 0; i < generated_.size(); ++i) {
            generated_[i] = std::max(0.0, generated_[i] + since_step_[i]);
            in_window_[i] += since_step_[i];
        }
        since_step_ = {};
    }
    count_windows(stepped, h);
    if (started_) {
        const bool was_slack = asked_.is_zero();
        double at_end = work(asked_W, X_WP_, X_WP);
        // until a proxy makes contact, it moves without work, unless it was hit
        if (was_slack) at_end = std::max(0.0, at_end);
        const double held = was_slack || slack ? at_end : work(asked_, X_WP_, X_WP);
        const double rest = stored - stored_ + to_hand;
        since_step_[0] += rest - at_end;
        since_step_[1] += rest - held;
        for (double& generated : generated_) generated *= std::exp(-h / kEnergyWindow);
    }
    started_ = true;
    X_WH_ = {handle.R_WH, handle.p_WH};
    X_WP_ = X_WP;
    asked_ = asked_W;
    stored_ = stored;
    damper_ = {};
    if (mode_ == frame::EnergyGuardMode::off) generated_ = {};  // feeding() keeps counting
    const double excess = generated() - budget_;
    if (excess <= 0) return damper_;
    status |= kEnergyGenerated;
    if (mode_ != frame::EnergyGuardMode::act) return damper_;
    damper_.force = braking(handle.v_WH, excess, h, kMostEnergyDamping);
    damper_.torque = braking(handle.w_WH, excess, h, kMostEnergyTurnDamping);
    if (!damper_.is_zero()) status |= kEnergyDamped;
    return damper_;
}

}  // namespace dihaptic::haptics
