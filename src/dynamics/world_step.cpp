// One step of the world, in the order of World::step().
//
//   1 loads         v <- v + h M^-1 (m g + f): gravity, applied forces and torques, before any
//                   contact, so that friction responds to all loads of this step. In Bullet's own
//                   order, friction does not respond to torques, and a held block turns. A driven
//                   body gets the velocity that takes it to its target instead.
//   2 free turns    w becomes its mean over the step in which the body turns freely (free_turn.h):
//                   contacts and joints need the final poses, which this mean gives.
//   3 contacts      are found in advance, with the velocities after the loads. A gap g lets bodies
//                   approach by at most g, so that nothing overlaps and nothing has to be
//                   pushed apart. Sleepers that are touched wake up, and join the step.
//   4 islands       of touching or joined bodies are solved one after the other, those with a
//                   finger first: a heap that no finger touches must not keep the hand waiting.
//   5 impulses      of contacts, friction and joints in one solve (src/contact). They are implicit:
//                   contacts, joints and motors hold for the velocities and positions at the END of
//                   the step, and springs and soft faces are as implicit as their stiffness
//                   requires. Joints and free turns are not linear there, and are solved
//                   iteratively. Bounces need a second solve, for velocities of separation, and
//                   must add no energy.
//   6 missed        Pairs that would still enter each other, because they turned or were
//                   knocked, get contacts, and everything is solved again from the same initial
//                   velocities. A body that no contact can stop waits in front of its obstacle.
//   7 positions     x <- x + h v, R <- exp(h w) R: semi-implicit Euler, by the new velocities.
//                   Then w <- I^-1 L for the new orientation, with the momentum L of the step.
//   8 published     are the bodies' states, contacts with their forces, joints with theirs, the
//                   statistics of the solve, and the books' energy and momentum. Last,
//                   groups that have been quiet for long enough fall asleep.
//
// A step never throws, allocates or reads a clock: its work is counted and bounded instead, so that
// a replay repeats it bit for bit. A step that diverges reports this and has no contacts, and later
// steps do nothing until mend(). README.md in this folder has the equations.
#include <algorithm>

#include "dynamics/free_turn.h"
#include "dynamics/world_impl.h"

namespace dihaptic::dynamics {
namespace {

/// Maximum number of additional solves of a step with contacts that were missing.
constexpr int kMostPasses = 4;
/// A body that contacts move by more than this may meet bodies that its bounds did not anticipate
/// [m].
constexpr double kKnocked = 1e-3;

ContactLaw law_of(const scene::PairSurface& surface, int sharing) {
    ContactLaw out;
    out.sharing = sharing;
    if (surface.is_soft()) {
        out.stiffness = surface.stiffness;
        out.damping = surface.damping;
    } else {
        out.restitution = surface.restitution;
    }
    return out;
}

}  // namespace

StepStatus World::step(double h) noexcept {
    Impl& w = *impl_;
    const auto diverge = [&] {
        w.diverged = true;
        contacts_.clear();
        stats_ = {};
        w.held_residual = 0;
        w.books.forget();
        return StepStatus::diverged;
    };
    if (w.diverged) return diverge();
    w.collect_awake(states_);
    w.books.begin(h);
    w.open_books(gravity_, false);
    w.integrate_loads(h, gravity_);
    if (!w.all_sound()) {  // check before any search by position
        for (const size_t i : w.awake) w.read_state(i, states_[i]);
        w.note_stepped();
        return diverge();
    }
    w.update_bounds(h);
    w.collision->find_contacts(h);
    w.collect_awake(states_);  // some bodies may have woken up
    w.open_books(gravity_, true);
    w.prepare_contacts(w.collision->manifolds(), h);
    for (btPersistentManifold* manifold : w.collision->manifolds()) even_out(*manifold);
    w.take_points(h);
    stats_ = w.solve_with_entered(h, gravity_, states_);
    w.integrate_positions(h);
    w.joints.end_step();
    w.joints.read();
    w.turn_on(states_);
    w.note_stepped();
    if (stats_.refused || !w.all_sound()) return diverge();

    w.close_books();
    const bool all = w.publish_contacts(h, contacts_) && !w.collision->overflowed();
    w.take_joints(h);
    w.books.balance();
    w.let_sleep(h, states_);
    return all ? StepStatus::ok : StepStatus::contacts_full;
}

bool World::Impl::publish_contacts(double h, std::vector<contact::Contact>& out) {
    out.clear();
    for (const btPersistentManifold* manifold : collision->manifolds()) {
        const int a = manifold->getBody0()->getUserIndex();
        const int b = manifold->getBody1()->getUserIndex();
        for (int i = 0; i < manifold->getNumContacts(); ++i) {
            if (out.size() == out.capacity()) return false;
            // Bullet's normal points from its body 1 to its body 0, and its impulses act on body 0
            const btManifoldPoint& point = manifold->getContactPoint(i);
            const Carried& impulse = carried(point);
            contact::Contact& contact = out.emplace_back();
            contact.a = {a};
            contact.b = {b};
            contact.p_WC = from_bullet(point.getPositionWorldOnB());
            contact.n_W = -normal_of(point);
            contact.gap = gap_of(point);
            contact.friction = point.m_combinedFriction;
            contact.normal_force = impulse.normal / h;
            contact.f_B_W = (impulse.normal * contact.n_W - impulse.friction_W) / h;
            // acts on the other body, about the opposite normal
            contact.moment = impulse.moment / h;
            take(contact, point, h);
        }
    }
    return true;
}

void World::Impl::wake(size_t i, std::vector<BodyState>& states) {
    states[i].awake = true;
    if (!sleep) return;  // not yet activated
    sleep->stir(i);
    if (!is_awake(i)) collision->sleepers_changed();
    items[i].body->setUserIndex2(kAwake);
    items[i].v_before = items[i].body->getLinearVelocity();
    items[i].w_before = items[i].body->getAngularVelocity();
    items[i].v_last = items[i].v_before;
    items[i].w_last = items[i].w_before;
    items[i].w_start = items[i].w_free = items[i].w_before;
    inverse_mass[i] = inverse_mass_of(items[i]);
    by_loads[i].setZero();
    items[i].bounces = false;
}

void World::Impl::place_fixed(size_t i, std::vector<BodyState>& states) {
    if (!collision) return;  // not yet activated
    for (const auto& part : items[i].parts) collision->update_bounds(*part, 0);
    for (const size_t k : can_move) wake(k, states);
    if (std::find(placed.begin(), placed.end(), i) == placed.end()) placed.push_back(i);
}

void World::Impl::note_stepped() {
    stepped.assign(awake.begin(), awake.end());
    stepped.insert(stepped.end(), placed.begin(), placed.end());
    placed.clear();
}

void World::Impl::wake_joined(std::vector<BodyState>& states) {
    for (bool found = true; found;) {
        found = false;
        for (size_t i = 0; i < joints.size(); ++i) {
            const Joints::Side& a = joints.a(i);
            const Joints::Side& b = joints.b(i);
            if (a.fixed || b.fixed || works(a) == works(b)) continue;
            wake((works(a) ? b : a).at(), states);
            found = true;
        }
    }
}

void World::Impl::collect_awake(std::vector<BodyState>& states) {
    wake_joined(states);
    awake.clear();
    for (const size_t i : can_move) {
        if (!is_awake(i)) continue;
        if (!states[i].awake) wake(i, states);
        awake.push_back(i);
    }
}

contact::Mat6 World::Impl::inverse_mass_of(const Item& item) const {
    contact::Mat6 out = contact::Mat6::Zero();
    if (item.is_led()) return out;
    // a body's inertia to linear motion may differ between the world's axes
    out.diagonal().head<3>() = item.properties.mass.cwiseInverse() * item.body->getInvMass();
    out.bottomRightCorner<3, 3>() = from_bullet(item.body->getInvInertiaTensorWorld());
    for (int i = 0; i < 3; ++i) {
        if (item.moves[i] == 0) contact::hold(out, i);
        if (item.turns[i] == 0) contact::hold(out, 3 + i);
    }
    return out;
}

Vec3 World::Impl::momentum(const Item& item, const Vec3& w_W) {
    const Quat R_WM = from_bullet(item.body->getWorldTransform()).R;
    const Vec3 inertia = from_bullet(item.body->getLocalInertia());
    return R_WM * Vec3(inertia.cwiseProduct(R_WM.conjugate() * w_W));
}

contact::Vec6 World::Impl::momentum(const Item& item, const contact::Vec6& v_W) {
    contact::Vec6 out;
    out.head<3>() = item.properties.mass.cwiseProduct(v_W.head<3>()) / item.body->getInvMass();
    out.tail<3>() = momentum(item, Vec3(v_W.tail<3>()));
    return out;
}

Vec3 World::Impl::mean_velocity(const Item& item, const Vec3& w_start, double h) {
    const Quat R_WM = from_bullet(item.body->getWorldTransform()).R;
    const Vec3 inertia = from_bullet(item.body->getLocalInertia());
    return dynamics::mean_velocity(R_WM, inertia, w_start, h);
}

void World::Impl::drive(Item& item, double h) {
    item.force.setZero();
    item.torque.setZero();
    Vec3 v = Vec3::Zero();
    Vec3 w = Vec3::Zero();
    if (item.drive_to) {
        const Pose X_WM = from_bullet(item.body->getWorldTransform());
        const Pose to = *item.drive_to * item.X_BM;
        v = (to.p - X_WM.p) / h;
        w = rotation_vector(to.R * X_WM.R.conjugate()) / h;
    }
    item.body->setLinearVelocity(to_bullet(v));
    item.body->setAngularVelocity(to_bullet(w));
    item.body->setInterpolationLinearVelocity(item.body->getLinearVelocity());
    item.body->setInterpolationAngularVelocity(item.body->getAngularVelocity());
}

void World::Impl::integrate_loads(double h, const Vec3& gravity) {
    for (const size_t i : awake) {
        Item& item = items[i];
        btRigidBody& body = *item.body;
        inverse_mass[i] = inverse_mass_of(item);
        item.v_last = body.getLinearVelocity();
        item.w_last = body.getAngularVelocity();
        by_loads[i].setZero();
        item.bounces = false;
        if (item.is_led()) {
            drive(item, h);
            continue;
        }
        contact::Vec6 load;
        load << item.force, item.torque;
        if (!item.is_proxy) load.head<3>() += item.properties.weight * item.mass * gravity;
        const contact::Vec6& change = by_loads[i] = h * (inverse_mass[i] * load);
        body.setLinearVelocity(body.getLinearVelocity() + to_bullet(Vec3(change.head<3>())));
        body.setAngularVelocity(body.getAngularVelocity() + to_bullet(Vec3(change.tail<3>())));
        limit_turn(body, h);
        item.force.setZero();
        item.torque.setZero();
        item.w_start = body.getAngularVelocity();
        if (item.turns_freely())
            body.setAngularVelocity(to_bullet(mean_velocity(item, from_bullet(item.w_start), h)));
        item.w_free = body.getAngularVelocity();
        // with these velocities, contacts are searched for in advance
        body.setInterpolationLinearVelocity(body.getLinearVelocity());
        body.setInterpolationAngularVelocity(body.getAngularVelocity());
    }
}

void World::Impl::update_bounds(double h) {
    for (const size_t i : awake) {
        if (items[i].is_point) continue;
        for (const auto& part : items[i].parts) collision->update_bounds(*part, h);
    }
}

bool World::Impl::is_sound(size_t i) const {
    const btRigidBody& body = *items[i].body;
    const btTransform& X = body.getWorldTransform();
    const btMatrix3x3& R = X.getBasis();
    const double size = X.getOrigin().length2() + body.getLinearVelocity().length2() +
                        body.getAngularVelocity().length2() + R[0].length2() + R[1].length2() +
                        R[2].length2();
    return size <= kBeyond * kBeyond;  // false if a value is not a number
}

bool World::Impl::all_sound() const {
    return std::all_of(awake.begin(), awake.end(), [&](size_t i) { return is_sound(i); });
}

contact::SolveStats World::Impl::solve_with_entered(double h, const Vec3& gravity,
                                                    std::vector<BodyState>& states) {
    for (const size_t i : awake) {
        items[i].v_before = items[i].body->getLinearVelocity();
        items[i].w_before = items[i].body->getAngularVelocity();
    }
    find_islands();
    work = has_fingers ? contact::Work(kMostSolveWork) : contact::Work();
    contact::Work search = has_fingers ? contact::Work(kMostSearchWork) : contact::Work();
    held_back = false;
    contact::SolveStats stats = solve(h);
    bool clear = false;
    for (int pass = 0; pass < kMostPasses && all_sound(); ++pass) {
        widen_bounds(h);
        clear = !collision->find_entered(h, settings.penetration_recovery, search);
        if (clear) break;
        collect_awake(states);
        open_books(gravity, true);
        prepare_contacts(collision->paths().found(), h);
        for (const size_t i : awake) {
            items[i].body->setLinearVelocity(items[i].v_before);
            items[i].body->setAngularVelocity(items[i].w_before);
            items[i].w_free = items[i].w_before;
        }
        find_islands();
        const contact::SolveStats before = stats;
        stats = solve(h);
        stats.iterations += before.iterations;
        stats.work += before.work;
    }
    if (!clear || collision->paths().is_unsure()) hold_back(h, search);
    stats.work += search.spent();
    if (collision->paths().was_cut()) {
        stats.missed = stats.ended = true;
        stats.route = contact::Route::out_of_work;
    }
    return stats;
}

void World::Impl::widen_bounds(double h) {
    for (const size_t i : awake) {
        if (items[i].is_point) continue;
        btRigidBody& body = *items[i].body;
        body.setInterpolationLinearVelocity(body.getLinearVelocity());
        body.setInterpolationAngularVelocity(body.getAngularVelocity());
        const btVector3 change = body.getLinearVelocity() - items[i].v_before;
        if (h * change.length() <= kKnocked) continue;
        for (const auto& part : items[i].parts) collision->widen_bounds(*part, h);
    }
}

void World::Impl::hold_back(double h, contact::Work& search) {
    constexpr int kMostRounds = 8;  // other bodies may run into waiting ones
    widen_bounds(h);
    for (int round = 0; round < kMostRounds && all_sound(); ++round) {
        if (!collision->hold_back(h, search)) break;
        while (wait_together()) continue;
    }
    for (const size_t i : awake) {
        constexpr double kStands = 0.01;
        constexpr int kMostStood = 2;  // [steps]: contacts will have acted by then
        Item& item = items[i];
        if (item.body->getHitFraction() < kStands && ++item.stood > kMostStood)
            item.body->setHitFraction(1);
        held_back = held_back || item.body->getHitFraction() < 1;
    }
}

bool World::Impl::wait_together() {
    bool found = false;
    for (size_t i = 0; i < joints.size(); ++i) {
        const Joints::Side& a = joints.a(i);
        const Joints::Side& b = joints.b(i);
        if (a.fixed || b.fixed) continue;
        btRigidBody& one = *items[a.at()].body;
        btRigidBody& other = *items[b.at()].body;
        const double share = std::min(one.getHitFraction(), other.getHitFraction());
        found = found || one.getHitFraction() != other.getHitFraction();
        one.setHitFraction(share);
        other.setHitFraction(share);
    }
    return found;
}

void World::Impl::prepare_contacts(std::span<btPersistentManifold* const> manifolds, double h) {
    for (btPersistentManifold* manifold : manifolds) {
        const auto [a, b] = bodies_of(*manifold);
        const scene::PairSurface& surface = surface_of(a, b);
        const int count = manifold->getNumContacts();
        give_to(*manifold);
        for (int i = 0; i < count; ++i) {
            btManifoldPoint& point = manifold->getContactPoint(i);
            point.m_combinedFriction = friction_of(a, b);
            carried(point).law = law_of(surface, count);
            // a finger does not bounce, because a held body would drum on it
            if (items[a].is_proxy || items[b].is_proxy) carried(point).law.restitution = 0;
        }
        if (has_texture(*manifold)) let_feel(*manifold);
        let_slide(*manifold, h);
    }
}

scene::Relief World::Impl::relief_at(size_t i, const Vec3& p_W, const Vec3& n_W) const noexcept {
    const Item& item = items[i];
    if (!item.relief) return {};
    const Pose X_WB = from_bullet(item.body->getWorldTransform()) * item.X_BM.inverse();
    const Pose X_BW = X_WB.inverse();
    scene::Relief out = item.relief->at(X_BW * p_W, X_BW.R * n_W);
    out.slope = X_WB.R * out.slope;
    return out;
}

bool World::Impl::has_texture(const btPersistentManifold& manifold) const {
    const auto [a, b] = bodies_of(manifold);
    return items[a].relief || items[b].relief;
}

void World::Impl::let_feel(btPersistentManifold& manifold) const {
    const auto [a, b] = bodies_of(manifold);
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
        btManifoldPoint& point = manifold.getContactPoint(i);
        const Vec3 p_W = from_bullet(point.getPositionWorldOnB());
        const Vec3 n_W = from_bullet(point.m_normalWorldOnB);
        const scene::Relief of_a = relief_at(a, p_W, -n_W);
        const scene::Relief of_b = relief_at(b, p_W, n_W);
        // the owner of a point has already included friction and textures
        if (!items[a].is_point && !items[b].is_point)
            point.m_combinedFriction *= of_a.friction * of_b.friction;
        carried(point).law.height = of_a.height + of_b.height;
        carried(point).law.slope_W = of_b.slope - of_a.slope;
    }
}

void World::Impl::take_points(double h) {
    const size_t found = collision->manifolds().size();
    point_contacts.take(collision->manifolds());
    for (btPersistentManifold* manifold : std::span(collision->manifolds()).subspan(found)) {
        give_to(*manifold);
        const btManifoldPoint& point = manifold->getContactPoint(0);
        carried(point).law = {};
        carried(point).law.compliance = PointContacts::compliance(point);
        if (has_texture(*manifold)) let_feel(*manifold);
        let_slide(*manifold, h);
    }
}

void World::Impl::let_slide(btPersistentManifold& manifold, double h) const {
    const auto [a, b] = bodies_of(manifold);
    const scene::PairSurface& surface = surface_of(a, b);
    if (surface.slides_like_coulomb()) return;
    double impulse = 0;
    for (int i = 0; i < manifold.getNumContacts(); ++i)
        impulse += carried(manifold.getContactPoint(i)).normal;
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
        btManifoldPoint& point = manifold.getContactPoint(i);
        const auto velocity = [&](size_t body) -> btVector3 {
            const Item& item = items[body];
            const btVector3 arm =
                point.getPositionWorldOnB() - item.body->getCenterOfMassPosition();
            return item.v_last + item.w_last.cross(arm);
        };
        const btVector3 u = velocity(a) - velocity(b);
        const double speed = (u - u.dot(point.m_normalWorldOnB) * point.m_normalWorldOnB).length();
        const double friction = surface.friction_at(speed, impulse / h);
        if (surface.friction > 0) {
            point.m_combinedFriction *= friction / surface.friction;
        } else {
            point.m_combinedFriction = friction;
        }
    }
}

void World::Impl::give_to(const btPersistentManifold& manifold) {
    if (carried_pool.give(manifold)) return;
    carried_pool.take_back([&](const auto& keep) {
        collision->for_each_manifold(keep);
        point_contacts.for_each_manifold(keep);
    });
    carried_pool.give(manifold);
}

void World::Impl::integrate_positions(double h) {
    for (const size_t i : awake) {
        Item& item = items[i];
        btRigidBody& body = *item.body;
        if (item.turns_freely()) {
            // contacts and joints act at the beginning of the step
            const btVector3& w_after = item.bounces ? item.w_leaves : body.getAngularVelocity();
            const btVector3 change = w_after - item.w_free;
            item.L_W = momentum(item, limited(from_bullet(item.w_start + change), h));
        }
        btTransform next;
        btTransformUtil::integrateTransform(body.getWorldTransform(), body.getLinearVelocity(),
                                            body.getAngularVelocity(),
                                            item.is_led() ? h : h * body.getHitFraction(), next);
        if (body.getHitFraction() == 1) item.stood = 0;
        body.setHitFraction(1);
        body.setWorldTransform(next);
        body.updateInertiaTensor();
        if (!item.bounces) continue;
        body.setLinearVelocity(item.v_leaves);
        body.setAngularVelocity(item.w_leaves);
    }
    for (const size_t i : awake) {
        if (!items[i].is_point) continue;
        items[i].body->getWorldTransform().getOrigin() += point_contacts.bend(*items[i].body, h);
    }
}

void World::Impl::turn_on(std::vector<BodyState>& states) {
    for (const size_t i : awake) {
        Item& item = items[i];
        if (item.turns_freely())
            item.body->setAngularVelocity(item.body->getInvInertiaTensorWorld() *
                                          to_bullet(item.L_W));
        item.drive_to.reset();
        read_state(i, states[i]);
    }
}

void World::Impl::read_state(size_t i, BodyState& state) const {
    const Item& item = items[i];
    state.X_WB = from_bullet(item.body->getWorldTransform()) * item.X_BM.inverse();
    state.w_WB = from_bullet(item.body->getAngularVelocity());
    state.v_WB =
        from_bullet(item.body->getLinearVelocity()) - state.w_WB.cross(state.X_WB.R * item.X_BM.p);
}

void World::Impl::let_sleep(double h, std::vector<BodyState>& states) {
    if (!settings.sleeping) return;
    for (const size_t i : awake) {
        if (items[i].is_proxy) {
            sleep->stir(i);  // no body touched by a finger may sleep
        } else {
            sleep->observe(i, states[i].v_WB, states[i].w_WB, h);
        }
    }
    sleep->judge(awake, *groups);
    for (const size_t i : awake) {
        if (!sleep->may_sleep(i, *groups)) continue;
        btRigidBody& body = *items[i].body;
        body.setLinearVelocity({0, 0, 0});
        body.setAngularVelocity({0, 0, 0});
        items[i].v_last = items[i].w_last = {0, 0, 0};
        body.setUserIndex2(0);
        collision->sleepers_changed();
        states[i].v_WB.setZero();
        states[i].w_WB.setZero();
        states[i].awake = false;
        books.rest(i);
    }
}

}  // namespace dihaptic::dynamics
