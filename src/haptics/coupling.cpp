#include "haptics/coupling.h"

#include <algorithm>

namespace dihaptic::haptics {
namespace {

/// Returns the part of the spring's force that lies in the friction cone of the step's contact.
Vec3 in_cone(const Vec3& spring, const ProxyTouch& touch) noexcept {
    const double normal = std::max(0.0, spring.dot(touch.n_W));
    Vec3 tangential = spring - spring.dot(touch.n_W) * touch.n_W;
    const double limit = touch.friction * normal;
    if (tangential.norm() > limit) tangential *= limit / tangential.norm();
    return normal * touch.n_W + tangential;
}

}  // namespace

double damping(const frame::CouplingSettings& settings, double h) {
    return settings.damping.value_or(settings.stiffness * h / 2);
}

double turn_damping(const frame::CouplingSettings& settings, double h) {
    return settings.turn_damping.value_or(settings.turn_stiffness * h / 2);
}

void BodyCoupling::begin_step(const frame::Handle& handle, double h) noexcept {
    damping_ = damping(settings_, h);
    handle_ = handle;
}

Pull BodyCoupling::pull(const World& world, BodyIndex proxy, const ProxyTouch& touch,
                        const frame::Handle& handle) const noexcept {
    const dynamics::BodyState& state = world.state(proxy);
    const double k = settings_.stiffness;
    const bool between_steps = touch.touching && !same(handle, handle_);
    const Vec3 stretch = state.X_WB.p - handle.p_WH;
    const Vec3 acting = between_steps ? in_cone(stretch, touch) : stretch;
    const double stored = onset_.share() * (k / 2 * acting.squaredNorm());
    if (!touch.touching) return {Vec3::Zero(), stored};
    const Vec3 spring = k * stretch + damping_ * (state.v_WB - handle.v_WH);
    return {onset_.share() * (between_steps ? in_cone(spring, touch) : spring), stored};
}

void ImplicitCoupling::before_step(World& world, BodyIndex proxy, const frame::Handle& handle,
                                   double h) noexcept {
    const dynamics::BodyState& state = world.state(proxy);
    begin_step(handle, h);
    const double k = settings_.stiffness;
    const double c = damping_;
    const double folded_mass = mass_ + h * c + h * h * k;
    // scales the whole equation: the velocity stays the same, and contacts stop less mass
    world.set_mass(proxy, onset_.share() * folded_mass);
    world.set_velocity(
        proxy, (mass_ * state.v_WB + h * k * (handle.p_WH - state.X_WB.p) + h * c * handle.v_WH) /
                   folded_mass);
}

void VelocityImpulse::before_step(World& world, BodyIndex proxy, const frame::Handle& handle,
                                  double h, bool was_touching) noexcept {
    const dynamics::BodyState& state = world.state(proxy);
    begin_step(handle, h);
    const double k = settings_.stiffness;
    const double c = damping_;
    // if the mass were smaller, a velocity towards the handle could not transmit the spring's force
    const double mass = std::max(mass_, h * c + h * h * k);
    const Vec3 stretch = handle.p_WH - state.X_WB.p;
    const Vec3 change = stretch / h - state.v_WB;
    const double most = h * max_force_ / mass;
    const double size = change.norm();
    double given = std::min(size, most);
    if (was_touching && size > 0) {
        // the force at the end of the step if the proxy kept its velocity; pulling lifts the proxy
        // off a surface
        const Vec3 spring = k * (stretch - h * state.v_WB) + c * (handle.v_WH - state.v_WB);
        given = std::clamp(h / mass * spring.dot(change) / size, -most, given);
    }
    world.set_mass(proxy, onset_.share() * mass);
    world.set_velocity(proxy, state.v_WB + (size > 0 ? given / size : 0) * change);
}

void DualSpring::before_step(World& world, BodyIndex proxy, const frame::Handle& handle, double h,
                             bool was_touching) noexcept {
    const dynamics::BodyState& state = world.state(proxy);
    double k = settings_.stiffness;
    if (!was_touching) {
        // limit k so that the proxy takes at least one or two steps to reach the handle; beyond
        // that, the explicit spring diverges
        k = std::max(k,
                     std::min(settings_.free_stiffening * k, 0.5 * settings_.body_mass / (h * h)));
    }
    const Vec3 stretch = handle.p_WH - state.X_WB.p;
    const Vec3 speed = handle.v_WH - state.v_WB;
    const Vec3 line = stretch.norm() > 0 ? Vec3(stretch.normalized()) : Vec3::Zero();
    const Vec3 along = speed.dot(line) * line;
    const Vec3 across = speed - along;
    world.set_mass(proxy, settings_.body_mass);
    const double share = was_touching ? onset_.share() : 1;
    world.apply(proxy,
                share * (k * stretch + settings_.body_damping_along * along +
                         settings_.body_damping_across * across),
                Vec3::Zero());
}

void DualSpring::sample(const World& world, BodyIndex proxy, const frame::Handle& handle,
                        double h) noexcept {
    const dynamics::BodyState& state = world.state(proxy);
    const Vec3 stretch = state.X_WB.p - handle.p_WH;
    const Vec3 line = stretch.norm() > 0 ? Vec3(stretch.normalized()) : Vec3::Zero();
    const Vec3 along = (state.v_WB - handle.v_WH).dot(line) * line;
    const Vec3 raw =
        onset_.share() * (settings_.stiffness * stretch + damping(settings_, h) * along);
    f_H_W_ = settings_.smoothing * raw + (1 - settings_.smoothing) * f_H_W_;
}

}  // namespace dihaptic::haptics
