#include "haptics/point_proxy.h"

#include <limits>

namespace dihaptic::haptics {
PointProxy::PointProxy(const scene::Scene& scene, BodyIndex body,
                       const frame::CouplingSettings& coupling,
                       const frame::ProxySettings& settings)
    : coupling_(coupling),
      shares_(scene.bodies.size(), 1),
      popthrough_(settings.popthrough.value_or(std::numeric_limits<double>::infinity())),
      body_(body),
      point_(scene.bodies, std::vector<double>(scene.bodies.size()), settings.sliding_friction),
      onset_(coupling.onset) {}

/// On a soft surface, on which the point presses less, friction balances less of the spring's
/// force.
void PointProxy::feel_surfaces(const World& world) noexcept {
    for (size_t i = 0; i < shares_.size(); ++i) {
        const BodyIndex body{static_cast<int>(i)};
        const scene::PairSurface& surface = world.surface(body, body_);
        shares_[i] =
            surface.is_soft() ? surface.stiffness / (surface.stiffness + coupling_.stiffness) : 1;
        Vec3 n_W = Vec3::UnitZ();
        for (const PointContact& c : point_.contacts()) {
            if (c.body == i) n_W = c.n_W;
        }
        point_.set_friction(i, shares_[i] * world.friction_at(body, body_, point_.position(), n_W));
    }
}

void PointProxy::place(World& world, const Vec3& p_WP) noexcept {
    point_.place(p_WP, world.states());
    world.set_point(body_, p_WP, Vec3::Zero());
    count_ = 0;
}

Pull PointProxy::render(World& world, const frame::Handle& handle, double h, double step) noexcept {
    const Vec3 before = point_.position();
    feel_surfaces(world);
    point_.follow(handle.p_WH, world.states());
    const Vec3& p_WP = point_.position();
    world.set_point(body_, p_WP, (p_WP - before) / h);

    count_ = 0;
    if (point_.contacts().empty()) return {Vec3::Zero(), stored(handle)};
    resolve(onset_.share() * (coupling_.stiffness * (p_WP - handle.p_WH) +
                              damping(coupling_, h) * (surface_velocity(world) - handle.v_WH)));
    Vec3 f_H_W = Vec3::Zero();
    for (const contact::Contact& c : contacts()) {
        f_H_W += c.f_B_W;
        // summed over all ticks of a step of the world, this gives their mean
        world.apply_at(c.a, -c.f_B_W * (h / step), p_WP);
    }
    for (const contact::Contact& c : contacts()) {
        if (c.normal_force > popthrough_)
            point_.pop_through(static_cast<size_t>(c.a.value), handle.p_WH);
    }
    return {f_H_W, stored(handle)};
}

/// Energy of the spring between the handle and the current point [J].
double PointProxy::stored(const frame::Handle& handle) const noexcept {
    return share_ * onset_.share() * coupling_.stiffness / 2 *
           (point_.position() - handle.p_WH).squaredNorm();
}

/// Velocity, at the point, of the surfaces that support it, weighted by depth.
Vec3 PointProxy::surface_velocity(const World& world) const noexcept {
    Vec3 sum = Vec3::Zero();
    double weight = 0;
    for (const PointContact& c : point_.contacts()) {
        const dynamics::BodyState& body = world.states()[c.body];
        sum += c.depth * (body.v_WB + body.w_WB.cross(point_.position() - body.X_WB.p));
        weight += c.depth;
    }
    return sum / weight;
}

/// Distributes a force over the contacts, each of which gets its part of the force on the handle.
void PointProxy::resolve(const Vec3& f_W) noexcept {
    HalfSpaces walls;
    for (const PointContact& c : point_.contacts()) walls.add(c.n_W);
    // the part of the handle's pull that the surfaces cannot support is left to friction
    Vec3 along = -walls.nearest(-f_W);
    double grip = 0;
    const auto touched = point_.contacts();
    for (size_t i = 0; i < touched.size(); ++i)
        grip += point_.friction(touched[i].body) * walls.multiplier[i];
    if (point_.sliding()) {
        // Coulomb's law: the magnitude is that of friction, whatever the spring and damper exert
        const double size = point_.held().norm();
        along = size > 0 ? Vec3(-point_.sliding_ratio() * grip / size * point_.held())
                         : Vec3(Vec3::Zero());
    } else if (const double size = along.norm(); size > grip) {
        along *= grip / size;
    }
    double pressed = 0;
    double given = 0;
    for (size_t i = 0; i < touched.size(); ++i) {
        const double share = shares_[touched[i].body];
        const double normal_force = share * walls.multiplier[i];
        if (normal_force <= 0) continue;
        pressed += walls.multiplier[i];
        given += normal_force;
        const double mu = point_.friction(touched[i].body) / share;
        contact::Contact& out = contacts_[count_++];
        out.a = {static_cast<int>(touched[i].body)};
        out.b = body_;
        out.p_WC = point_.position();
        out.n_W = touched[i].n_W;
        out.gap = 0;
        out.friction = mu;
        out.normal_force = normal_force;
        out.f_B_W = normal_force * touched[i].n_W;
        if (grip > 0) out.f_B_W += mu * normal_force / grip * along;
    }
    share_ = pressed > 0 ? given / pressed : 1;
}

}  // namespace dihaptic::haptics
