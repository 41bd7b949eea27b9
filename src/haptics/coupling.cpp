#include "haptics/coupling.h"

#include <algorithm>

namespace dihaptic::haptics {
namespace {

/// What the step's contact can bear of it.
Vec3 in_cone(const Vec3& spring, const ProxyTouch& touch) {
    const double normal = std::max(0.0, spring.dot(touch.n_W));
    Vec3 tangential = spring - spring.dot(touch.n_W) * touch.n_W;
    const double limit = touch.friction * normal;
    if (tangential.norm() > limit) tangential *= limit / tangential.norm();
    return normal * touch.n_W + tangential;
}

}  // namespace

double damping(const CouplingSettings& settings, double h) {
    return settings.damping.value_or(settings.stiffness * h / 2);
}

void ImplicitCoupling::before_step(World& world, BodyIndex proxy, const Handle& handle,
                                   double h) noexcept {
    const dynamics::BodyState& state = world.state(proxy);
    const double k = settings_.stiffness;
    const double c = damping(settings_, h);
    damping_ = c;
    handle_ = handle;
    const double folded_mass = mass_ + h * c + h * h * k;
    world.set_mass(proxy, folded_mass);
    world.set_velocity(
        proxy, (mass_ * state.v_WB + h * k * (handle.p_WH - state.X_WB.p) + h * c * handle.v_WH) /
                   folded_mass);
}

Vec3 ImplicitCoupling::force(const World& world, BodyIndex proxy, const ProxyTouch& touch,
                             const Handle& handle) const noexcept {
    // in free space the spring only moves the proxy's own mass: nothing that a hand should feel
    if (!touch.touching) return Vec3::Zero();
    const dynamics::BodyState& state = world.state(proxy);
    Vec3 spring =
        settings_.stiffness * (state.X_WB.p - handle.p_WH) + damping_ * (state.v_WB - handle.v_WH);
    return of_this_step(handle) ? spring : in_cone(spring, touch);
}

double ImplicitCoupling::stored(const World& world, BodyIndex proxy, const ProxyTouch& touch,
                                const Handle& handle) const noexcept {
    if (!touch.touching) return 0;
    Vec3 stretch = world.state(proxy).X_WB.p - handle.p_WH;
    if (!of_this_step(handle)) stretch = in_cone(stretch, touch);
    return settings_.stiffness / 2 * stretch.squaredNorm();
}

void DualSpring::before_step(World& world, BodyIndex proxy, const Handle& handle, double h,
                             bool was_touching) noexcept {
    const dynamics::BodyState& state = world.state(proxy);
    double k = settings_.stiffness;
    if (!was_touching) {
        // no stiffer than what takes the proxy to the handle in a step or two: beyond, the explicit
        // spring diverges
        k = std::max(k,
                     std::min(settings_.free_stiffening * k, 0.5 * settings_.body_mass / (h * h)));
    }
    const Vec3 stretch = handle.p_WH - state.X_WB.p;
    const Vec3 speed = handle.v_WH - state.v_WB;
    const Vec3 line = stretch.norm() > 0 ? Vec3(stretch.normalized()) : Vec3::Zero();
    const Vec3 along = speed.dot(line) * line;
    const Vec3 across = speed - along;
    world.set_mass(proxy, settings_.body_mass);
    world.apply(
        proxy,
        k * stretch + settings_.body_damping_along * along + settings_.body_damping_across * across,
        Vec3::Zero());
}

void DualSpring::sample(const World& world, BodyIndex proxy, const Handle& handle,
                        double h) noexcept {
    const dynamics::BodyState& state = world.state(proxy);
    const Vec3 stretch = state.X_WB.p - handle.p_WH;
    const Vec3 line = stretch.norm() > 0 ? Vec3(stretch.normalized()) : Vec3::Zero();
    const Vec3 along = (state.v_WB - handle.v_WH).dot(line) * line;
    const Vec3 raw = settings_.stiffness * stretch + damping(settings_, h) * along;
    f_H_W_ = settings_.smoothing * raw + (1 - settings_.smoothing) * f_H_W_;
}

}  // namespace dihaptic::haptics
