#include "haptics/rotational_coupling.h"

#include <algorithm>

namespace dihaptic::haptics {

void RotationalCoupling::before_step(World& world, BodyIndex proxy, const frame::Handle& handle,
                                     double share, double h) noexcept {
    const dynamics::BodyState& state = world.state(proxy);
    const double k = settings_.turn_stiffness;
    const double c = turn_damping(settings_, h);
    damping_ = c;
    handle_ = handle;
    const double folded = inertia_ + h * c + h * h * k;
    const Vec3 way = rotation_vector(wanted(handle) * state.X_WB.R.conjugate());
    world.set_inertia(proxy, share * folded);
    world.set_angular_velocity(
        proxy, (inertia_ * state.w_WB + h * k * way + h * c * handle.w_WH) / folded);
}

Vec3 RotationalCoupling::torque(const World& world, BodyIndex proxy, bool touching,
                                const frame::Handle& handle, double share) noexcept {
    const bool of_step = same(handle, handle_);
    if (of_step) along_.setZero();
    const dynamics::BodyState& state = world.state(proxy);
    Vec3 stretch = rotation_vector(state.X_WB.R * wanted(handle).conjugate());
    stored_ = share * settings_.turn_stiffness / 2 * stretch.squaredNorm();
    // as for forces: in free space, the spring only turns the inertia of the proxy itself
    if (!touching) return Vec3::Zero();
    Vec3 torque = settings_.turn_stiffness * stretch + damping_ * (state.w_WB - handle.w_WH);
    if (of_step) {
        const double size = torque.norm();
        if (size > 0) along_ = torque / size;
    } else {
        stretch = std::max(0.0, stretch.dot(along_)) * along_;
        torque = std::max(0.0, torque.dot(along_)) * along_;
    }
    stored_ = share * settings_.turn_stiffness / 2 * stretch.squaredNorm();
    return share * torque;
}

}  // namespace dihaptic::haptics
