// Enters a step into the books.
#include <algorithm>
#include <cmath>

#include "dynamics/world_impl.h"

namespace dihaptic::dynamics {

Books::Motion World::Impl::motion_of(const Item& item) {
    const btTransform& X_WM = item.body->getWorldTransform();
    return {from_bullet(X_WM.getOrigin()), from_bullet(X_WM.getBasis()),
            from_bullet(item.body->getLinearVelocity()),
            from_bullet(item.body->getAngularVelocity())};
}

Books::Body World::Impl::account_of(const Item& item, const Vec3& gravity) {
    Books::Body out;
    out.moves = item.moves;
    out.turns = item.turns;
    out.is_led = item.is_point || item.is_led();
    out.is_outside = item.is_proxy || out.is_led;
    if (item.is_proxy) {  // a proxy's mass changes with its coupling
        out.masses.setConstant(item.body->getMass());
        out.moments = from_bullet(item.body->getLocalInertia());
        return out;
    }
    out.masses = item.mass * item.properties.mass;
    out.moments = item.properties.turning * item.inertia;
    out.weight_W = item.properties.weight * item.mass * gravity;
    return out;
}

void World::Impl::open_books(const Vec3& gravity, bool late) {
    for (const size_t i : awake) {
        if (late && books.is_open(i)) continue;
        books.open(i, account_of(items[i], gravity), motion_of(items[i]),
                   {items[i].force, items[i].torque}, late);
    }
}

void World::Impl::close_books() {
    for (const size_t i : awake) books.close(i, motion_of(items[i]), items[i].bounces);
}

void World::Impl::take(const contact::Contact& contact, const btManifoldPoint& point, double h) {
    const ContactLaw& law = carried(point).law;
    const Vec3& n_W = contact.n_W;
    Books::Exchange exchange{.a = contact.a.value,
                             .b = contact.b.value,
                             .p_W = carried(point).acts_at_W,
                             .apart_W = carried(point).apart * n_W,
                             .impulse_W = h * contact.f_B_W,
                             .moment_W = h * contact.moment * n_W};
    const Books::Meeting meeting = books.meet(exchange);
    const bool is_rigid = law.stiffness == 0 && law.compliance == 0;
    if (is_rigid) books.check_gap(exchange, meeting, n_W, contact.gap);
    if (is_rigid && exchange.impulse_W.isZero(0) && contact.moment == 0) return;
    const double normal = h * contact.normal_force;
    const double mean_work = normal * n_W.dot(meeting.v_mean);
    // pressure must not separate bodies, and friction must not drive their sliding
    double pressing = normal * n_W.dot(meeting.v_after);
    const Vec3 friction_W = exchange.impulse_W - normal * n_W;
    const double twisting = exchange.moment_W.dot(meeting.w_after);
    double rubbing = friction_W.dot(meeting.v_after) + twisting;
    if (rubbing > 0) {  // velocities are tangential to the arcs of the points
        rubbing = friction_W.dot(books.way(exchange)) / h + twisting;
    }
    if (is_rigid && law.restitution == 0) {
        pressing -= returned(carried(point), contact.gap, normal, n_W.dot(meeting.v_after), h);
    }
    if (!ahead_of(point).isZero(0)) {
        // a rolling rim touches with this point halfway between before and after
        pressing = mean_work;
        rubbing = friction_W.dot(meeting.v_mean) + exchange.moment_W.dot(meeting.w_mean);
    }
    if (law.stiffness > 0) {
        const auto stored = [&](double gap) {
            const double k = law.stiffness / law.sharing;
            return gap < 0 ? k * gap * gap / 2 : 0;
        };
        // velocities are those in the middle of steps
        exchange.stored_before = stored(contact.gap - h / 2 * n_W.dot(meeting.v_before()));
        exchange.stored_after = stored(contact.gap + h / 2 * n_W.dot(meeting.v_after));
        pressing = mean_work + exchange.stored_after - exchange.stored_before;
    } else if (law.restitution > 0) {
        // the time of contact within the step is unknown, and so is the loads' work until then
        pressing = mean_work - std::abs(loads_at(contact, point) * h);
    }
    exchange.found = std::max(0.0, pressing) + std::max(0.0, rubbing);
    books.take(exchange, meeting);
}

double World::Impl::returned(Carried& contact, double gap, double normal, double speed, double h) {
    const double room = std::max(gap, 0.0) / h;
    if (gap >= 0) contact.sunk = 0;
    contact.sunk += normal * std::max(0.0, -speed - room);
    const double undone = normal * std::clamp(speed, 0.0, std::max(0.0, -gap / h));
    const double out = std::min(undone, contact.sunk);
    contact.sunk -= out;
    return out;
}

double World::Impl::loads_at(const contact::Contact& contact, const btManifoldPoint& point) const {
    const auto along = [&](contact::BodyIndex body) {
        const auto i = static_cast<size_t>(body.value);
        const Vec3 arm =
            carried(point).acts_at_W - from_bullet(items[i].body->getCenterOfMassPosition());
        const contact::Vec6& change = by_loads[i];
        return contact.n_W.dot(change.head<3>() + change.tail<3>().cross(arm));
    };
    return contact.normal_force * (along(contact.b) - along(contact.a));
}

void World::Impl::take_joints(double h) {
    for (size_t i = 0; i < joints.size(); ++i) {
        const Books::Meeting meeting =
            books.meet({.a = joints.a(i).item, .b = joints.b(i).item, .p_W = joints.acts_at(i)});
        books.take(joints.exchange(i, h, meeting), meeting);
    }
}

}  // namespace dihaptic::dynamics
