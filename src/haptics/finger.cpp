#include "haptics/finger.h"

namespace dihaptic::haptics {

Finger::Finger(const scene::Finger& finger, BodyIndex proxy,
               const frame::CouplingSettings& coupling, double max_force)
    : proxy_(proxy),
      coupling_(ImplicitCoupling(coupling, finger.mass)),
      mass_(finger.mass),
      max_force_(max_force) {
    retune(coupling);
}

Finger::Finger(PointProxy point, BodyIndex proxy) : proxy_(proxy), coupling_(std::move(point)) {}

Finger::Finger(SolvedPoint point, BodyIndex proxy) : proxy_(proxy), coupling_(std::move(point)) {}

void Finger::retune(const frame::CouplingSettings& coupling) noexcept {
    const bool is_body = mass_ > 0;
    if (is_body && coupling.kind != kind_) {
        if (coupling.kind == frame::CouplingKind::implicit)
            coupling_ = ImplicitCoupling(coupling, mass_);
        if (coupling.kind == frame::CouplingKind::dual_spring) coupling_ = DualSpring(coupling);
        if (coupling.kind == frame::CouplingKind::velocity_impulse)
            coupling_ = VelocityImpulse(coupling, mass_, max_force_);
        kind_ = coupling.kind;
    } else {
        std::visit([&](auto& of) { of.retune(coupling); }, coupling_);
    }
    if (turn_) turn_->retune(coupling);
}

std::span<const contact::Contact> Finger::contacts() const noexcept {
    const auto* point = std::get_if<PointProxy>(&coupling_);
    return point != nullptr ? point->contacts() : std::span<const contact::Contact>();
}

void Finger::place(World& world, const frame::Handle& handle) noexcept {
    Pose X_WP = world.state(proxy_).X_WB;
    X_WP.p = handle.p_WH;
    if (turn_) X_WP.R = turn_->wanted(handle);
    world.set_pose(proxy_, X_WP);
    R_TP_ = X_WP.R;
    if (auto* dual = std::get_if<DualSpring>(&coupling_)) dual->place();
    if (auto* point = std::get_if<PointProxy>(&coupling_)) point->place(world, handle.p_WH);
    if (auto* point = std::get_if<SolvedPoint>(&coupling_)) point->place(world, handle.p_WH);
}

void Finger::carry(World& world, const Quat& R_WT, const Vec3& w_WT) const noexcept {
    if (!turn_) world.carry(proxy_, R_WT * R_TP_, w_WT);
}

void Finger::begin_tick(const World& world, const frame::Handle& handle, double step) noexcept {
    step_ = step;
    if (auto* dual = std::get_if<DualSpring>(&coupling_)) dual->sample(world, proxy_, handle, step);
}

void Finger::before_step(World& world, const frame::Handle& handle, double step) noexcept {
    if (auto* implicit = std::get_if<ImplicitCoupling>(&coupling_)) {
        implicit->before_step(world, proxy_, handle, step);
    } else if (auto* dual = std::get_if<DualSpring>(&coupling_)) {
        dual->before_step(world, proxy_, handle, step, touch_.touching);
    } else if (auto* impulse = std::get_if<VelocityImpulse>(&coupling_)) {
        impulse->before_step(world, proxy_, handle, step, touch_.touching);
    } else if (auto* point = std::get_if<SolvedPoint>(&coupling_)) {
        point->before_step(world, handle, step);
    }
    if (turn_) turn_->before_step(world, proxy_, handle, onset_share(), step);
}

void Finger::after_step(World& world, const frame::Handle& handle) noexcept {
    // a point with friction "apart" feels bodies at their current poses, in pull()
    if (!std::holds_alternative<PointProxy>(coupling_)) feel(world.contacts());
    if (auto* point = std::get_if<SolvedPoint>(&coupling_)) point->after_step(world, handle);
}

void Finger::feel(std::span<const contact::Contact> contacts) noexcept {
    touch_ = {};
    Vec3 normal = Vec3::Zero();
    double pressed = 0;
    double weighted_friction = 0;
    for (const contact::Contact& c : contacts) {
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

Pull Finger::pull(World& world, const frame::Handle& handle, double tick) noexcept {
    if (auto* implicit = std::get_if<ImplicitCoupling>(&coupling_))
        return implicit->pull(world, proxy_, touch_, handle);
    if (auto* dual = std::get_if<DualSpring>(&coupling_)) return dual->pull(world, proxy_, handle);
    if (auto* impulse = std::get_if<VelocityImpulse>(&coupling_))
        return impulse->pull(world, proxy_, touch_, handle);
    if (auto* solved = std::get_if<SolvedPoint>(&coupling_))
        return solved->pull(world, handle, tick);
    auto& point = std::get<PointProxy>(coupling_);
    const Pull pull = point.render(world, handle, tick, step_);
    feel(point.contacts());
    return pull;
}

Vec3 Finger::force(World& world, const frame::Handle& handle, double tick) noexcept {
    const Pull pull = this->pull(world, handle, tick);
    stored_ = pull.stored;
    if (turn_) {
        torque_ = turn_->torque(world, proxy_, touch_.touching, handle, onset_share());
        stored_ += turn_->stored();
    }
    std::visit([&](auto& coupling) { coupling.onset().advance(touch_.touching, tick); }, coupling_);
    return pull.f_H_W;
}

double Finger::onset_share() noexcept {
    return std::visit([](auto& coupling) { return coupling.onset().share(); }, coupling_);
}

}  // namespace dihaptic::haptics
