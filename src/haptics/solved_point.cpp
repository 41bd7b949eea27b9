#include "haptics/solved_point.h"

#include <limits>

namespace dihaptic::haptics {
namespace {

/// A point counts as at rest if it moves more slowly than this along a surface [m/s]. The errors of
/// solvers are a few nm/s.
constexpr double kRest = 1e-6;

/// The point starts each step on the surface, as if unloaded. During the step, it yields at a speed
/// u, chosen such that the contact's impulse r = (v - u) m is that of both springs in series; v = h
/// k x / m is the speed towards which the coupling pulls the point. This gives u / r = k / (k_s m).
double give(const scene::PairSurface& surface, double stiffness, double mass) {
    return surface.is_soft() ? stiffness / (surface.stiffness * mass) : 0;
}

}  // namespace

SolvedPoint::SolvedPoint(const scene::Scene& scene, BodyIndex body,
                         const frame::CouplingSettings& coupling,
                         const frame::ProxySettings& settings)
    : coupling_(coupling),
      onset_(coupling.onset),
      body_(body),
      // the step determines the position of the point, including friction
      point_(scene.bodies, std::vector<double>(scene.bodies.size(), 0), 1),
      sliding_friction_(settings.sliding_friction),
      popthrough_(settings.popthrough.value_or(std::numeric_limits<double>::infinity())) {}

void SolvedPoint::place(World& world, const Vec3& p_WP) noexcept {
    point_.place(p_WP, world.states());
    world.set_point(body_, p_WP, Vec3::Zero());
}

void SolvedPoint::before_step(World& world, const frame::Handle& handle, double h) noexcept {
    step_ = h;
    just_stepped_ = true;
    const double k = coupling_.stiffness;
    const double c = damping(coupling_, h);
    const double mass = h * c + h * h * k;
    const Vec3& p_WP = point_.position();
    const Vec3 v_WP = (h * k * (handle.p_WH - p_WP) + h * c * handle.v_WH) / mass;
    mass_ = onset_.share() * mass;
    world.set_mass(body_, mass_);
    world.set_point(body_, p_WP, v_WP);
    const double share = sliding_ ? sliding_friction_ : 1;
    for (const Obstacle& o : point_.obstacles(p_WP + h * v_WP, world.states(), h)) {
        const BodyIndex body{static_cast<int>(o.body)};
        world.meet(body_, {body, static_cast<int>(o.surface), o.face, o.n_W, o.gap, share,
                           give(world.surface(body, body_), k, mass_)});
    }
}

void SolvedPoint::after_step(World& world, const frame::Handle& handle) noexcept {
    const dynamics::BodyState solved = world.state(body_);
    v_WP_ = solved.v_WB;
    press_count_ = 0;
    f_P_W_.setZero();
    sliding_ = false;
    double given = 0;
    double pressed = 0;
    for (const contact::Contact& c : world.contacts()) {
        if (c.b != body_ || c.normal_force <= 0) continue;
        const double share = share_of(world, c.a);
        presses_[press_count_++] = {c.n_W, c.friction, share};
        // the point yields away from the surface, but still ends on it
        v_WP_ += give(world.surface(c.a, body_), coupling_.stiffness, mass_) * step_ *
                 c.normal_force * c.n_W;
        given += c.normal_force;
        pressed += c.normal_force / share;
        f_P_W_ += c.f_B_W;
        const Vec3 slip_B = world.state(c.a).X_WB.inverse() * solved.X_WB.p -
                            point_.position_in(static_cast<size_t>(c.a.value));
        const Vec3 slip_W = world.state(c.a).X_WB.R * slip_B;
        sliding_ = sliding_ || (slip_W - slip_W.dot(c.n_W) * c.n_W).norm() > kRest * step_;
    }
    share_ = pressed > 0 ? given / pressed : 1;
    point_.move(solved.X_WB.p, world.states());
    if (press_count_ == 0) point_.slide(handle.p_WH);
    for (const contact::Contact& c : world.contacts()) {
        if (c.b != body_ || c.normal_force <= popthrough_) continue;
        point_.pop_through(static_cast<size_t>(c.a.value), handle.p_WH);
        press_count_ = 0;
    }
    world.set_point(body_, point_.position(), v_WP_);
}

Pull SolvedPoint::pull(World& world, const frame::Handle& handle, double h) noexcept {
    if (just_stepped_) {
        just_stepped_ = false;
        return {f_P_W_, energy(point_.position() - handle.p_WH)};
    }
    if (press_count_ == 0) {
        const Vec3 f_H_W = meet_between_steps(world, handle, h);
        return {f_H_W, energy(point_.position() - handle.p_WH)};
    }
    const Vec3 stretch = point_.position() - handle.p_WH;
    return {in_cones(onset_.share() * (coupling_.stiffness * stretch +
                                       damping(coupling_, step_) * (v_WP_ - handle.v_WH))),
            energy(in_cones(stretch))};
}

double SolvedPoint::share_of(const World& world, BodyIndex body) const noexcept {
    const scene::PairSurface& surface = world.surface(body, body_);
    return surface.is_soft() ? surface.stiffness / (surface.stiffness + coupling_.stiffness) : 1;
}

double SolvedPoint::energy(const Vec3& stretch) const noexcept {
    return share_ * onset_.share() * coupling_.stiffness / 2 * stretch.squaredNorm();
}

/// Returns the part of the spring's force that the step's contacts can support.
Vec3 SolvedPoint::in_cones(const Vec3& spring) const noexcept {
    HalfSpaces walls;
    for (size_t i = 0; i < press_count_; ++i) walls.add(presses_[i].n_W);
    Vec3 along = -walls.nearest(-spring);
    Vec3 pressing = spring - along;
    double grip = 0;
    for (size_t i = 0; i < press_count_; ++i) {
        const double normal_force = presses_[i].share * walls.multiplier[i];
        pressing -= (1 - presses_[i].share) * walls.multiplier[i] * presses_[i].n_W;
        grip += presses_[i].friction * normal_force;
    }
    if (const double size = along.norm(); size > grip) along *= grip / size;
    return pressing + along;
}

/// A surface that is first met between two steps has no friction until the next step.
Vec3 SolvedPoint::meet_between_steps(World& world, const frame::Handle& handle, double h) noexcept {
    point_.slide(handle.p_WH);
    world.set_point(body_, point_.position(), handle.v_WH);
    HalfSpaces walls;
    for (const PointContact& c : point_.contacts()) walls.add(c.n_W);
    walls.nearest(-(coupling_.stiffness * (point_.position() - handle.p_WH) -
                    damping(coupling_, h) * handle.v_WH));
    Vec3 f_H_W = Vec3::Zero();
    for (size_t i = 0; i < walls.count; ++i) {
        const PointContact& c = point_.contacts()[i];
        const BodyIndex body{static_cast<int>(c.body)};
        const Vec3 f_W = share_of(world, body) * onset_.share() * walls.multiplier[i] * c.n_W;
        world.apply_at(body, -f_W * (h / step_), point_.position());
        f_H_W += f_W;
    }
    return f_H_W;
}

}  // namespace dihaptic::haptics
