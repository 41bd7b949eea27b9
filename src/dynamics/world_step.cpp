#include <algorithm>

#include "dynamics/world_impl.h"

namespace dihaptic::dynamics {
namespace {

/// Groups without a finger are solved together up to this many contact pairs: fewer calls, and few
/// groups that wait for the iterations of another.
constexpr size_t kBatch = 32;
/// How many times a step may be solved again, with contacts that turn out to be lacking.
constexpr int kMostPasses = 4;
/// A body that contacts move by more than this may meet things that it could not meet otherwise
/// [m].
constexpr double kKnocked = 1e-3;

}  // namespace

StepStatus World::step(double h) noexcept {
    Impl& w = *impl_;
    const auto diverge = [&] {
        w.diverged = true;
        contacts_.clear();
        stats_ = {};
        return StepStatus::diverged;
    };
    if (w.diverged) return diverge();
    w.collect_awake(states_);
    w.integrate_loads(h, gravity_);
    if (!w.all_sound()) {  // before anything is looked up by its position
        for (const size_t i : w.awake) w.read_state(i, states_[i]);
        return diverge();
    }
    w.update_bounds(h);
    w.collision->find_contacts(h);
    w.collect_awake(states_);  // some may have woken
    w.prepare_contacts(w.collision->manifolds());
    for (btPersistentManifold* manifold : w.collision->manifolds()) even_out(*manifold);
    w.point_contacts.take(w.collision->manifolds());
    stats_ = w.solve_with_entered(h, states_);
    w.integrate_positions(h, states_);
    if (stats_.refused || !w.all_sound()) return diverge();

    StepStatus status = w.collision->overflowed() ? StepStatus::contacts_full : StepStatus::ok;
    contacts_.clear();
    for (const btPersistentManifold* manifold : w.collision->manifolds()) {
        const int a = manifold->getBody0()->getUserIndex();
        const int b = manifold->getBody1()->getUserIndex();
        for (int i = 0; i < manifold->getNumContacts(); ++i) {
            if (contacts_.size() == contacts_.capacity()) {
                status = StepStatus::contacts_full;
                break;
            }
            // Bullet's normal points from its body 1 to its body 0, and its impulses act on body 0
            const btManifoldPoint& point = manifold->getContactPoint(i);
            const btVector3 impulse = point.m_appliedImpulse * point.m_normalWorldOnB +
                                      point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                                      point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2;
            contact::Contact& out = contacts_.emplace_back();
            out.a = {a};
            out.b = {b};
            out.p_WC = from_bullet(point.getPositionWorldOnB());
            out.n_W = -from_bullet(point.m_normalWorldOnB);
            out.gap = point.getDistance();
            out.friction = point.m_combinedFriction;
            out.normal_force = point.m_appliedImpulse / h;
            out.f_B_W = -from_bullet(impulse) / h;
            // about a's outward normal, which is opposite to Bullet's
            out.moment = w.settings.solver == Solver::sequential_impulse
                             ? 0
                             : torsion_impulse(manifold->getContactPoint(i)) / h;
        }
    }
    w.let_sleep(h, states_);
    return status;
}

void World::Impl::wake(size_t i, std::vector<BodyState>& states) {
    states[i].awake = true;
    if (!sleep) return;  // not yet activated
    sleep->stir(i);
    if (!is_awake(i)) collision->sleepers_changed();
    items[i].body->setUserIndex2(kAwake);
    items[i].v_before = items[i].body->getLinearVelocity();
    items[i].w_before = items[i].body->getAngularVelocity();
}

void World::Impl::collect_awake(std::vector<BodyState>& states) {
    awake.clear();
    for (const size_t i : can_move) {
        if (!is_awake(i)) continue;
        if (!states[i].awake) wake(i, states);
        awake.push_back(i);
    }
}

void World::Impl::integrate_loads(double h, const Vec3& gravity) {
    for (const size_t i : awake) {
        Item& item = items[i];
        btRigidBody& body = *item.body;
        Vec3 acceleration = item.force * body.getInvMass();
        if (!item.is_proxy) acceleration += item.heaviness * gravity;
        body.setLinearVelocity(body.getLinearVelocity() +
                               h * to_bullet(acceleration) * body.getLinearFactor());
        const btVector3 turn = body.getInvInertiaTensorWorld() * to_bullet(item.torque);
        // a proxy has the same inertia about all axes
        const btVector3 gyroscopic = item.is_proxy || body.getAngularFactor().isZero()
                                         ? btVector3(0, 0, 0)
                                         : body.computeGyroscopicImpulseImplicit_Body(h);
        body.setAngularVelocity(body.getAngularVelocity() +
                                (h * turn + gyroscopic) * body.getAngularFactor());
        item.force.setZero();
        item.torque.setZero();
        // contacts are searched ahead by these velocities
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
    return size <= kBeyond * kBeyond;  // false for values that are not numbers
}

bool World::Impl::all_sound() const {
    return std::all_of(awake.begin(), awake.end(), [&](size_t i) { return is_sound(i); });
}

contact::SolveStats World::Impl::solve_with_entered(double h, std::vector<BodyState>& states) {
    for (const size_t i : awake) {
        items[i].v_before = items[i].body->getLinearVelocity();
        items[i].w_before = items[i].body->getAngularVelocity();
    }
    group_contacts();
    contact::SolveStats stats = solve(h);
    for (int pass = 0; pass < kMostPasses && all_sound(); ++pass) {
        for (const size_t i : awake) {
            if (items[i].is_point) continue;
            btRigidBody& body = *items[i].body;
            body.setInterpolationLinearVelocity(body.getLinearVelocity());
            body.setInterpolationAngularVelocity(body.getAngularVelocity());
            const btVector3 change = body.getLinearVelocity() - items[i].v_before;
            if (h * change.length() <= kKnocked) continue;
            for (const auto& part : items[i].parts) collision->update_bounds(*part, h);
        }
        if (!collision->find_entered(h, settings.penetration_recovery)) break;
        collect_awake(states);
        prepare_contacts(collision->entered());
        for (const size_t i : awake) {
            items[i].body->setLinearVelocity(items[i].v_before);
            items[i].body->setAngularVelocity(items[i].w_before);
        }
        group_contacts();
        const int iterations = stats.iterations;
        stats = solve(h);
        stats.iterations += iterations;
    }
    return stats;
}

void World::Impl::prepare_contacts(std::span<btPersistentManifold* const> manifolds) {
    for (btPersistentManifold* manifold : manifolds) {
        const auto a = static_cast<size_t>(manifold->getBody0()->getUserIndex());
        const auto b = static_cast<size_t>(manifold->getBody1()->getUserIndex());
        for (int i = 0; i < manifold->getNumContacts(); ++i) {
            manifold->getContactPoint(i).m_combinedFriction = friction_of(a, b);
            // Bullet's solver has no torsion
            const bool torsion = settings.solver != Solver::sequential_impulse;
            torsion_radius(manifold->getContactPoint(i)) =
                torsion ? std::max(items[a].torsion_radius, items[b].torsion_radius) : 0;
        }
    }
}

void World::Impl::group_contacts() {
    groups->reset();
    const std::vector<btPersistentManifold*>& manifolds = collision->manifolds();
    const auto indices = [](const btPersistentManifold& manifold) {
        return std::pair{static_cast<size_t>(manifold.getBody0()->getUserIndex()),
                         static_cast<size_t>(manifold.getBody1()->getUserIndex())};
    };
    for (const btPersistentManifold* manifold : manifolds) {
        const auto [a, b] = indices(*manifold);
        if (items[a].can_move && items[b].can_move) groups->join(a, b);
    }
    grouped_bodies.clear();
    grouped_contacts.clear();
    for (const size_t i : awake) {
        grouped_bodies.push_back({groups->of(i), static_cast<int>(i), items[i].body.get()});
    }
    for (btPersistentManifold* manifold : manifolds) {
        const auto [a, b] = indices(*manifold);
        const auto order = static_cast<int>(grouped_contacts.size());
        grouped_contacts.push_back({groups->of(items[a].can_move ? a : b), order, manifold});
    }
    std::sort(grouped_bodies.begin(), grouped_bodies.end());
    std::sort(grouped_contacts.begin(), grouped_contacts.end());
}

contact::SolveStats World::Impl::solve(double h) {
    contact::SolveStats stats;
    const bool by_group = settings.solver != Solver::sequential_impulse;
    const auto finish_batch = [&] {
        if (batch_contacts.empty()) return;
        stats.join(solve_batch(h));
        batch_bodies.clear();
        batch_contacts.clear();
    };
    auto body = grouped_bodies.begin();
    auto contact = grouped_contacts.begin();
    while (contact != grouped_contacts.end()) {
        const size_t group = contact->group;
        while (body->group < group) ++body;  // bodies that touch nothing
        const auto first_body = body;
        bool has_finger = false;
        for (; body != grouped_bodies.end() && body->group == group; ++body) {
            has_finger = has_finger || items[static_cast<size_t>(body->order)].is_proxy;
        }
        // a held object takes many iterations, and nothing else must wait for it
        if (has_finger || by_group) finish_batch();
        for (auto b = first_body; b != body; ++b) batch_bodies.push_back(b->item);
        for (; contact != grouped_contacts.end() && contact->group == group; ++contact) {
            batch_contacts.push_back(contact->item);
        }
        if (has_finger || batch_contacts.size() >= kBatch) finish_batch();
    }
    finish_batch();
    return stats;
}

contact::SolveStats World::Impl::solve_batch(double h) {
    contact::SolveStats stats;
    problem.build(batch_bodies, batch_contacts, h, settings.penetration_recovery,
                  settings.warm_start);
    if (watcher) watcher(problem.problem(), problem.impulses());
    if (settings.solver != Solver::sequential_impulse) {
        const contact::PolygonSettings polygon{settings.friction_directions,
                                               settings.friction_frame};
        if (solvers.solve(settings.solver, polygon, problem.problem(), problem.impulses(), stats)) {
            problem.store(batch_contacts);
            for (size_t i = 0; i < batch_bodies.size(); ++i) {
                btRigidBody& body = *btRigidBody::upcast(batch_bodies[i]);
                const auto change = solvers.velocity_change(static_cast<int>(i));
                body.setLinearVelocity(body.getLinearVelocity() +
                                       to_bullet(Vec3(change.head<3>())));
                body.setAngularVelocity(body.getAngularVelocity() +
                                        to_bullet(Vec3(change.tail<3>())));
            }
            return stats;
        }
        stats.fallback = true;  // the group is too large: Bullet's solver grows with it
    }
    square_root_factors(true);
    stats.iterations = sequential_impulse.solve(batch_bodies, batch_contacts, settings, h,
                                                collision->dispatcher());
    square_root_factors(false);
    stats.residual = problem.judge(batch_contacts);
    stats.missed = !(stats.residual <= contact::kTolerance);
    stats.route = contact::Route::sequential_impulse;
    return stats;
}

void World::Impl::square_root_factors(bool rooted) {
    for (btCollisionObject* object : batch_bodies) {
        const Item& item = items[static_cast<size_t>(object->getUserIndex())];
        if (item.properties.mass == Vec3::Constant(item.properties.mass.x())) continue;
        const Vec3 factor = item.properties.mass.minCoeff() * item.properties.mass.cwiseInverse();
        item.body->setLinearFactor(item.moves *
                                   to_bullet(rooted ? Vec3(factor.cwiseSqrt()) : factor));
    }
}

void World::Impl::integrate_positions(double h, std::vector<BodyState>& states) {
    for (const size_t i : awake) {
        btRigidBody& body = *items[i].body;
        btTransform next;
        btTransformUtil::integrateTransform(body.getWorldTransform(), body.getLinearVelocity(),
                                            body.getAngularVelocity(), h, next);
        body.setWorldTransform(next);
        body.updateInertiaTensor();
        if (!items[i].is_point) read_state(i, states[i]);
    }
    for (const size_t i : awake) {
        if (!items[i].is_point) continue;
        items[i].body->getWorldTransform().getOrigin() += point_contacts.bend(*items[i].body, h);
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
            sleep->stir(i);  // nothing that a finger touches may sleep
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
        body.setUserIndex2(0);
        collision->sleepers_changed();
        states[i].v_WB.setZero();
        states[i].w_WB.setZero();
        states[i].awake = false;
    }
}

}  // namespace dihaptic::dynamics
