#include "haptics/point_proxy.h"

#include <limits>

namespace dihaptic::haptics {
namespace {

std::vector<double> frictions(const scene::Scene& scene, const scene::Finger& finger) {
    std::vector<double> out;
    for (const scene::Body& body : scene.bodies) {
        out.push_back(
            scene::pair_friction(scene, body.name, body.friction, finger.name, finger.friction));
    }
    return out;
}

}  // namespace

PointProxy::PointProxy(const scene::Scene& scene, size_t finger, BodyIndex body,
                       const CouplingSettings& coupling, const ProxySettings& settings)
    : coupling_(coupling),
      popthrough_(settings.popthrough.value_or(std::numeric_limits<double>::infinity())),
      body_(body),
      point_(scene.bodies, frictions(scene, scene.fingers[finger]), settings.sliding_friction),
      onset_(coupling.onset) {}

void PointProxy::place(World& world, const Vec3& p_WP) noexcept {
    point_.place(p_WP, world.states());
    world.set_point(body_, p_WP, Vec3::Zero());
    count_ = 0;
}

Pull PointProxy::render(World& world, const Handle& handle, double h, double step) noexcept {
    const Vec3 before = point_.position();
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
        // summed over all ticks in a step of the world, this is their mean
        world.apply_at(c.a, -c.f_B_W * (h / step), p_WP);
    }
    for (const contact::Contact& c : contacts()) {
        if (c.normal_force > popthrough_)
            point_.pop_through(static_cast<size_t>(c.a.value), handle.p_WH);
    }
    return {f_H_W, stored(handle)};
}

/// Energy of the spring to the point where it is now [J].
double PointProxy::stored(const Handle& handle) const noexcept {
    return onset_.share() * coupling_.stiffness / 2 *
           (point_.position() - handle.p_WH).squaredNorm();
}

/// Velocity at the point of the surfaces that it rests on, weighted by depth.
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

/// Resolves a force into contacts, each with its part of the force on the handle.
void PointProxy::resolve(const Vec3& f_W) noexcept {
    HalfSpaces walls;
    for (const PointContact& c : point_.contacts()) walls.add(c.n_W);
    // what the surfaces cannot take of the handle's pull is left to friction
    Vec3 along = -walls.nearest(-f_W);
    double grip = 0;
    const auto touched = point_.contacts();
    for (size_t i = 0; i < touched.size(); ++i)
        grip += point_.friction(touched[i].body) * walls.multiplier[i];
    if (point_.sliding()) {
        // Coulomb's law: the size is that of friction, whatever spring and damper give
        const double size = point_.held().norm();
        along = size > 0 ? Vec3(-point_.sliding_ratio() * grip / size * point_.held())
                         : Vec3(Vec3::Zero());
    } else if (const double size = along.norm(); size > grip) {
        along *= grip / size;
    }
    for (size_t i = 0; i < touched.size(); ++i) {
        const double normal_force = walls.multiplier[i];
        if (normal_force <= 0) continue;
        const double mu = point_.friction(touched[i].body);
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
}

}  // namespace dihaptic::haptics
