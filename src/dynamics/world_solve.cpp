// Finds the islands of a step, and their impulses (stages 4 and 5 of world_step.cpp). Each island
// is solved for the velocities at the end of the step, repeatedly with better guesses of these
// velocities if joints or free turns are not linear, and once more if something in the island
// bounces. Neither a bounce nor a solve that misses the tolerance may add energy (README.md in this
// folder).
#include <algorithm>
#include <limits>

#include "dynamics/world_impl.h"

namespace dihaptic::dynamics {
namespace {

/// Maximum number of visits in the solve of an island without a finger while a hand waits for the
/// tick: enough for newton on stacks of ten bodies; heaps are solved by sweeps.
constexpr int kMostWork = 4000;
/// Number of sweeps that even the largest such island gets: with fewer, the heap of two hundred
/// bodies of `dihaptic-bench heap` gains so much energy that the books do not balance.
constexpr int kFewestSweepsOfHeap = 10;
/// An island with more contacts than this is a heap if the limit on work ends its solve. Smaller
/// ones, such as a tower of bars, have time for better guesses.
constexpr size_t kFewContactsOfHeap = 64;
/// The share of penetration_recovery that applies in such an island. In a jam, bodies can hardly
/// move apart: undoing overlaps at the full speed takes forces several times as large as those that
/// rest there, sweeps are far from these, and the energy that they supply makes the books differ.
constexpr double kRecoveryOfHeap = 0.05;
/// Represents an unbounded energy.
constexpr double kNoBound = std::numeric_limits<double>::infinity();

}  // namespace

void World::Impl::join_groups() {
    groups->reset();
    for (const btPersistentManifold* manifold : collision->manifolds()) {
        const auto [a, b] = bodies_of(*manifold);
        if (items[a].can_move && items[b].can_move) groups->join(a, b);
    }
    for (size_t i = 0; i < joints.size(); ++i) {
        const Joints::Side& a = joints.a(i);
        const Joints::Side& b = joints.b(i);
        if (works(a) && works(b)) groups->join(a.at(), b.at());
    }
}

void World::Impl::find_islands() {
    join_groups();
    std::fill(holds_finger.begin(), holds_finger.end(), false);
    for (const size_t i : awake) {
        if (items[i].is_proxy) holds_finger[groups->of(i)] = true;
    }
    const auto island_of = [&](size_t body) {
        const size_t group = groups->of(body);
        return holds_finger[group] ? group : items.size() + group;
    };
    bodies_of_islands.clear();
    contacts_of_islands.clear();
    joints_of_islands.clear();
    for (const size_t i : awake)
        bodies_of_islands.push_back({island_of(i), static_cast<int>(i), items[i].body.get()});
    for (btPersistentManifold* manifold : collision->manifolds()) {
        const auto [a, b] = bodies_of(*manifold);
        const auto order = static_cast<int>(contacts_of_islands.size());
        contacts_of_islands.push_back({island_of(items[a].can_move ? a : b), order, manifold});
    }
    for (size_t i = 0; i < joints.size(); ++i) {
        const Joints::Side& side = works(joints.a(i)) ? joints.a(i) : joints.b(i);
        if (works(side))
            joints_of_islands.push_back({island_of(side.at()), static_cast<int>(i), i});
    }
    std::sort(joints_of_islands.begin(), joints_of_islands.end());
    std::sort(bodies_of_islands.begin(), bodies_of_islands.end());
    std::sort(contacts_of_islands.begin(), contacts_of_islands.end());
}

int64_t World::Impl::held_islands() const {
    int64_t count = 0;
    size_t last = items.size();  // the islands from here on have no finger
    for (const auto& contact : contacts_of_islands) {
        if (contact.island >= items.size()) break;
        if (contact.island != last) ++count;
        last = contact.island;
    }
    return count;
}

contact::SolveStats World::Impl::solve(double h) {
    contact::SolveStats stats;
    held_residual = 0;
    int64_t left = held_islands();
    auto body = bodies_of_islands.begin();
    auto contact = contacts_of_islands.begin();
    auto joint = joints_of_islands.begin();
    const auto take = [](auto& at, auto end, size_t island, auto& out) {
        out.clear();
        for (; at != end && at->island == island; ++at) out.push_back(at->item);
    };
    while (body != bodies_of_islands.end()) {
        const size_t island = body->island;
        take(body, bodies_of_islands.end(), island, island_bodies);
        take(contact, contacts_of_islands.end(), island, island_contacts);
        take(joint, joints_of_islands.end(), island, island_joints);
        for (btCollisionObject* object : island_bodies) object->setUserIndex3(0);
        if (island_contacts.empty() && island_joints.empty()) continue;
        const bool held = island < items.size();
        work.share(held ? left-- : 1);  // no island with a finger uses up the others' share
        const contact::SolveStats one = solve_island(h, held);
        if (held) held_residual = std::max(held_residual, one.residual);
        stats.join(one);
        if (held || !is_heap(one)) continue;
        for (btCollisionObject* object : island_bodies) object->setUserIndex3(kInHeap);
    }
    return stats;
}

int World::Impl::most_work(bool held) {
    if (!has_fingers || held) return contact::kUnbounded;
    const auto contacts = static_cast<int>(problem.impulses().size());
    return std::max(kMostWork, kFewestSweepsOfHeap * contact::kVisitsPerSweep * contacts);
}

bool World::Impl::is_heap(const contact::SolveStats& stats) {
    const bool bounded = stats.ended && stats.route != contact::Route::out_of_work;
    return bounded && island_joints.empty() && problem.impulses().size() > kFewContactsOfHeap;
}

double World::Impl::recovery_of_island(bool held) const {
    if (!has_fingers || held || !island_joints.empty()) return settings.penetration_recovery;
    size_t contacts = 0;
    for (const btPersistentManifold* manifold : island_contacts)
        contacts += static_cast<size_t>(manifold->getNumContacts());
    return (contacts > kFewContactsOfHeap ? kRecoveryOfHeap : 1) * settings.penetration_recovery;
}

contact::SolveStats World::Impl::solve_island(double h, bool held) {
    problem.build(island_bodies, inverse_mass, island_contacts, h, recovery_of_island(held),
                  settings.warm_start);
    problem.add_joints(joints, island_joints, h, settings.warm_start);
    if (watcher) watcher(problem.problem(), problem.impulses());
    const contact::SolveSettings how{{settings.friction_directions, settings.friction_frame},
                                     {settings.iterations, settings.tolerance},
                                     most_work(held),
                                     &work};
    contact::SolveStats stats = solve_guessing(how, h);
    problem.store(island_contacts);
    island_change.clear();
    for (size_t i = 0; i < island_bodies.size(); ++i)
        island_change.push_back(solvers.velocity_change(static_cast<int>(i)));
    if (stats.missed && !island_joints.empty()) forbid_gain();
    problem.store(joints, island_joints, island_change, h);
    for (size_t i = 0; i < island_bodies.size(); ++i) {
        btRigidBody& body = *btRigidBody::upcast(island_bodies[i]);
        items[static_cast<size_t>(body.getUserIndex())].bounces = false;
        const contact::Vec6& change = island_change[i];
        body.setLinearVelocity(body.getLinearVelocity() + to_bullet(Vec3(change.head<3>())));
        body.setAngularVelocity(body.getAngularVelocity() + to_bullet(Vec3(change.tail<3>())));
        limit_turn(body, h);
    }
    if (problem.bounce(island_contacts, by_loads)) let_bounce(how, h, stats);
    return stats;
}

void World::Impl::let_bounce(const contact::SolveSettings& how, double h,
                             contact::SolveStats& stats) {
    contact::SolveStats after;
    problem.keep();
    solvers.solve(solver_of_island(), how, problem.problem(), problem.impulses(),
                  problem.joint_impulses(), after);
    const double share = share_of_bounce();
    problem.mix(share);
    stats.join(after);
    problem.store(island_contacts);
    for (size_t i = 0; i < island_bodies.size(); ++i) {
        const contact::Vec6 bounced = solvers.velocity_change(static_cast<int>(i));
        // if share is 1, use `bounced` itself: first + (bounced - first) would differ from it in
        // the last digit, due to rounding
        island_change[i] =
            share == 1 ? bounced
                       : contact::Vec6(island_change[i] + share * (bounced - island_change[i]));
    }
    problem.store(joints, island_joints, island_change, h);
    for (size_t i = 0; i < island_bodies.size(); ++i) {
        btRigidBody& body = *btRigidBody::upcast(island_bodies[i]);
        Item& item = items[static_cast<size_t>(body.getUserIndex())];
        const contact::Vec6& change = island_change[i];
        item.bounces = true;
        item.v_leaves = item.v_before + to_bullet(Vec3(change.head<3>()));
        const btVector3 w = item.w_free + to_bullet(Vec3(change.tail<3>()));
        item.w_leaves = to_bullet(limited(from_bullet(w), h));
    }
}

contact::Vec6 World::Impl::velocity_before(size_t i) const {
    const Item& item = items[i];
    contact::Vec6 out;
    out << from_bullet(item.v_before), from_bullet(item.w_start);
    return out;
}

double World::Impl::most_energy() const {
    if (std::any_of(island_joints.begin(), island_joints.end(),
                    [&](size_t joint) { return joints.is_driven(joint); }))
        return kNoBound;
    double before = 0;
    double loads = 0;
    for (const btCollisionObject* body : island_bodies) {
        const auto i = static_cast<size_t>(body->getUserIndex());
        if (items[i].is_led()) return kNoBound;
        const contact::Vec6 v = velocity_before(i);
        before += v.dot(momentum(items[i], v));
        loads += by_loads[i].dot(momentum(items[i], by_loads[i]));
    }
    double springs = 0;
    for (const size_t joint : island_joints) springs += joints.stored(joint);
    for (const btPersistentManifold* manifold : island_contacts) {
        for (int i = 0; i < manifold->getNumContacts(); ++i) {
            const ContactLaw& law = carried(manifold->getContactPoint(i)).law;
            if (law.compliance > 0) return kNoBound;
            if (law.stiffness == 0) continue;
            const double gap = std::min(gap_of(manifold->getContactPoint(i)), 0.0);
            springs += law.stiffness / law.sharing * gap * gap / 2;
        }
    }
    const double most = std::sqrt(before) + 2 * std::sqrt(loads);
    return most * most + 2 * springs;
}

void World::Impl::forbid_gain() {
    const double most = most_energy();
    if (most == kNoBound) return;
    double after = 0;
    for (size_t i = 0; i < island_bodies.size(); ++i) {
        const auto at = static_cast<size_t>(island_bodies[i]->getUserIndex());
        const contact::Vec6 v = velocity_before(at) + island_change[i];
        after += v.dot(momentum(items[at], v));
    }
    if (after <= most) return;
    const double share = std::sqrt(most / after);
    for (size_t i = 0; i < island_bodies.size(); ++i) {
        const contact::Vec6 v =
            velocity_before(static_cast<size_t>(island_bodies[i]->getUserIndex()));
        island_change[i] = share * (v + island_change[i]) - v;
    }
}

double World::Impl::share_of_bounce() const {
    const double most = most_energy();
    if (most == kNoBound) return 1;
    double first = 0;  // twice the energy of the first answer
    double product = 0;
    double added = 0;
    for (size_t i = 0; i < island_bodies.size(); ++i) {
        const auto at = static_cast<size_t>(island_bodies[i]->getUserIndex());
        const contact::Vec6 v = velocity_before(at) + island_change[i];
        const contact::Vec6 change =
            solvers.velocity_change(static_cast<int>(i)) - island_change[i];
        first += v.dot(momentum(items[at], v));
        product += change.dot(momentum(items[at], v));
        added += change.dot(momentum(items[at], change));
    }
    const double room = std::max(most - first, 1e-9 * first);
    if (2 * product + added <= room) return 1;
    // solution of added s^2 + 2 product s = room
    return (std::sqrt(product * product + added * room) - product) / added;
}

contact::Solver World::Impl::solver_of_island() const {
    // sweeps leave errors in chains of joints, which would gain energy from step to step
    const bool sweeps = settings.solver == contact::Solver::sequential_impulse;
    return sweeps && !island_joints.empty() ? contact::Solver::newton : settings.solver;
}

contact::SolveStats World::Impl::solve_guessing(const contact::SolveSettings& how, double h) {
    constexpr int kMostGuesses = 8;
    /// Each guess of a free rotation multiplies the error by half the angle turned in a step. More
    /// guesses do not help if a stiff spring turns a body back within the step.
    constexpr int kMostTurnGuesses = 3;
    constexpr double kSame = 1e-9;  // [m/s], [rad/s]
    /// If guesses still differ by this much, they will not converge, because the joined bodies turn
    /// too fast for the step [m/s], [rad/s].
    constexpr double kLost = 1e-2;
    const contact::Solver solver = solver_of_island();
    int iterations = 0;
    int64_t work_before = 0;
    for (int guess = 1;; ++guess) {
        contact::SolveStats stats;
        solvers.solve(solver, how, problem.problem(), problem.impulses(), problem.joint_impulses(),
                      stats);
        iterations = stats.iterations += iterations;
        work_before = stats.work += work_before;
        const bool is_last = guess > kMostGuesses || stats.route == contact::Route::out_of_work;
        // the last guess leaves small errors in the island's joints
        stats.missed = stats.missed || (is_last && !island_joints.empty());
        if (is_last || stats.refused) return stats;
        island_change.clear();
        for (size_t i = 0; i < island_bodies.size(); ++i)
            island_change.push_back(solvers.velocity_change(static_cast<int>(i)));
        if (is_heap(stats)) {
            // sweeps leave a far greater error than the guess, but the bodies must turn as the
            // impulses demand
            guess_turns(h);
            return stats;
        }
        const double off = std::max(guess > kMostTurnGuesses ? 0 : guess_turns(h),
                                    problem.guess(joints, island_joints, h, island_change));
        if (off <= kSame || (guess == kMostGuesses && off < kLost)) return stats;
        if (guess == kMostGuesses) problem.hold(joints, island_joints, h);
    }
}

double World::Impl::guess_turns(double h) {
    constexpr double kSame = 1e-6;  // [rad/s]
    double most = 0;
    for (size_t i = 0; i < island_bodies.size(); ++i) {
        btRigidBody& body = *btRigidBody::upcast(island_bodies[i]);
        Item& item = items[static_cast<size_t>(body.getUserIndex())];
        if (!item.turns_freely()) continue;
        const Vec3 change = island_change[i].tail<3>();
        const Vec3 w_begins = limited(from_bullet(item.w_start) + change, h);
        const Vec3 w_free = mean_velocity(item, w_begins, h) - change;
        const double off = (w_free - from_bullet(item.w_free)).norm();
        if (off <= kSame) continue;
        most = std::max(most, off);
        item.w_free = to_bullet(w_free);
        body.setAngularVelocity(item.w_free);
        problem.set_free_turn(i, w_free);
    }
    return most;
}

}  // namespace dihaptic::dynamics
