#include "haptics/finger.h"

namespace dihaptic::haptics {

Finger::Finger(const scene::Finger& finger, BodyIndex proxy, const CouplingSettings& coupling,
               double max_force, double max_force_rate)
    : proxy_(proxy),
      coupling_(make_coupling(coupling, finger.mass)),
      limiter_(max_force, max_force_rate) {}

void Finger::begin_tick(const World& world, const Handle& handle, double step) noexcept {
    if (auto* dual = std::get_if<DualSpring>(&coupling_)) dual->sample(world, proxy_, handle, step);
}

void Finger::before_step(World& world, const Handle& handle, double step) noexcept {
    if (auto* implicit = std::get_if<ImplicitCoupling>(&coupling_)) {
        implicit->before_step(world, proxy_, handle, step);
    } else {
        std::get<DualSpring>(coupling_).before_step(world, proxy_, handle, step, touch_.touching);
    }
}

void Finger::after_step(const World& world) noexcept {
    touch_ = {};
    Vec3 normal = Vec3::Zero();
    double pressed = 0;
    double weighted_friction = 0;
    for (const contact::Contact& c : world.contacts()) {
        if (c.a != proxy_ && c.b != proxy_) continue;
        const double sign = c.b == proxy_ ? 1.0 : -1.0;
        normal += sign * c.normal_force * c.n_W;
        pressed += c.normal_force;
        weighted_friction += c.normal_force * c.friction;
        touch_.f_P_W += sign * c.f_B_W;
    }
    if (pressed <= 0) return;
    touch_.touching = true;
    touch_.normal_force = normal.norm();
    if (touch_.normal_force > 0) touch_.n_W = normal / touch_.normal_force;
    touch_.friction = weighted_friction / pressed;
}

Finger::Output Finger::force(const World& world, const Handle& handle, double tick) noexcept {
    Output out;
    if (auto* implicit = std::get_if<ImplicitCoupling>(&coupling_)) {
        out.f_asked_W = implicit->force(world, proxy_, touch_, handle);
    } else {
        out.f_asked_W = std::get<DualSpring>(coupling_).force();
    }
    out.f_H_W = limiter_.limit(out.f_asked_W, tick, out.flags);
    return out;
}

}  // namespace dihaptic::haptics
