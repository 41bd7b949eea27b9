#include "dynamics/world.h"

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cassert>

#include "dynamics/bullet/collision.h"
#include "dynamics/bullet/shape.h"
#include "dynamics/bullet/solver.h"
#include "dynamics/sleep.h"

namespace dihaptic::dynamics {
namespace {

/// Mass, centre of mass and principal inertia of a solid.
struct Solid {
    double mass = 0;
    Vec3 inertia = Vec3::Zero();  ///< principal moments [kg*m^2]
    Pose X_BM;                    ///< centre of mass and principal axes in B
};

Solid solid_of(const scene::Shape& shape, double mass) {
    Solid out;
    out.mass = mass;
    const scene::VolumeIntegrals unit = scene::integrate(shape);
    if (mass <= 0 || unit.volume <= 0) return out;
    const double density = mass / unit.volume;
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(density * unit.inertia);
    out.X_BM.p = unit.centre;
    if (unit.inertia.isDiagonal(1e-9)) {
        out.inertia = density * unit.inertia.diagonal();
    } else {
        Mat3 R = axes.eigenvectors();
        if (R.determinant() < 0) R.col(0) *= -1;
        out.X_BM.R = Quat(R);
        out.inertia = axes.eigenvalues();
    }
    return out;
}

btVector3 factors(scene::Axes axes) {
    return {contains(axes, 0) ? 1.0 : 0.0, contains(axes, 1) ? 1.0 : 0.0,
            contains(axes, 2) ? 1.0 : 0.0};
}

}  // namespace

/// Something of a group of bodies that touch.
template <class T>
struct Grouped {
    size_t group;
    int order;  // among its like: keeps sorting stable without memory
    T item;
    bool operator<(const Grouped& other) const {
        return group != other.group ? group < other.group : order < other.order;
    }
};

/// Groups without a finger are solved together up to so many pairs: fewer calls, and few that wait
/// for another group's iterations.
constexpr size_t kBatch = 32;

struct World::Impl {
    struct Item {
        std::string name;
        double friction = 0;
        bool is_proxy = false;
        bool can_move = false;
        Pose X_BM;
        Vec3 inertia = Vec3::Zero();
        std::unique_ptr<btCollisionShape> shape;
        std::unique_ptr<Polyhedron> polyhedron;
        std::unique_ptr<btRigidBody> body;
        Vec3 force = Vec3::Zero();
        Vec3 torque = Vec3::Zero();
    };

    const scene::Scene& scene() const { return scene_; }

    scene::Scene scene_;
    Settings settings;
    std::vector<Item> items;
    std::vector<size_t> awake;  // bodies that take part in the step
    std::vector<size_t> can_move;
    std::vector<Grouped<btCollisionObject*>> grouped_bodies;  // awake, by group
    std::vector<Grouped<btPersistentManifold*>> grouped_contacts;
    std::vector<btCollisionObject*> batch_bodies;
    std::vector<btPersistentManifold*> batch_contacts;
    std::vector<double> friction;  // by pair, row-major
    std::unique_ptr<Collision> collision;
    std::unique_ptr<Groups> groups;
    std::unique_ptr<SleepKeeper> sleep;
    SequentialImpulse sequential_impulse;

    void add(const std::string& name, const scene::Shape& shape, double mass,
             double friction_coefficient, const Pose& X_WB, const btVector3& linear,
             const btVector3& angular);
    bool is_awake(size_t i) const { return items[i].body->getUserIndex2() == kAwake; }
    void wake(size_t i, std::vector<BodyState>& states);
    void collect_awake(std::vector<BodyState>& states);
    void integrate_loads(double h, const Vec3& gravity);
    void prepare_contacts();
    void group_contacts();
    contact::SolveStats solve(double h);
    void integrate_positions(double h, std::vector<BodyState>& states);
    void read_state(size_t i, BodyState& state) const;
    void let_sleep(double h, std::vector<BodyState>& states);
};

void World::Impl::add(const std::string& name, const scene::Shape& shape, double mass,
                      double friction_coefficient, const Pose& X_WB, const btVector3& linear,
                      const btVector3& angular) {
    Item item;
    item.name = name;
    item.friction = friction_coefficient;
    item.can_move = mass > 0 && !(linear.isZero() && angular.isZero());
    Solid solid = solid_of(shape, item.can_move ? mass : 0);
    const bool one_axis = angular.length2() == 1;
    if (one_axis) {
        // held to one axis e, only I_ee counts; spread over all axes, any orientation of M gives it
        const Mat3 R = (X_WB.R * solid.X_BM.R).toRotationMatrix();
        const Vec3 e = from_bullet(angular);
        solid.inertia.setConstant(e.dot(R * solid.inertia.asDiagonal() * R.transpose() * e));
    }
    item.X_BM = solid.X_BM;
    item.inertia = solid.inertia;
    item.shape = bullet_shape(shape, item.X_BM);
    item.polyhedron = polyhedron(shape, item.X_BM);

    btRigidBody::btRigidBodyConstructionInfo info(solid.mass, nullptr, item.shape.get(),
                                                  to_bullet(item.inertia));
    info.m_startWorldTransform = to_bullet(X_WB * item.X_BM);
    item.body = std::make_unique<btRigidBody>(info);
    item.body->setFlags(0);  // no gyroscopic term in Bullet's solver: integrate_loads() has it
    item.body->setLinearFactor(linear);
    item.body->setAngularFactor(angular);
    item.body->setUserPointer(item.polyhedron.get());
    item.body->setUserIndex(static_cast<int>(items.size()));
    item.body->setUserIndex2(item.can_move ? kAwake : 0);
    if (item.can_move) item.body->setActivationState(DISABLE_DEACTIVATION);
    items.push_back(std::move(item));
}

World::World(const scene::Scene& scene, const Settings& settings)
    : impl_(std::make_unique<Impl>()), gravity_(scene.gravity) {
    impl_->scene_ = scene;
    impl_->settings = settings;
    for (const scene::Body& body : scene.bodies) {
        const bool fixed = body.fixed;
        impl_->add(body.name, body.shape, fixed ? 0 : scene::mass(body), body.friction, body.pose(),
                   fixed ? btVector3(0, 0, 0) : factors(body.moves),
                   fixed ? btVector3(0, 0, 0) : factors(body.turns));
    }
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

BodyIndex World::add_proxy(const scene::Finger& finger, const Vec3& p_WP) {
    impl_->add(finger.name, finger.shape, finger.mass, finger.friction,
               {rotation_xyz(finger.rotation), p_WP}, btVector3(1, 1, 1), btVector3(0, 0, 0));
    impl_->items.back().is_proxy = true;
    return {size() - 1};
}

void World::activate() {
    Impl& w = *impl_;
    const size_t count = w.items.size();
    const int max_contacts = w.settings.max_contacts > 0
                                 ? w.settings.max_contacts
                                 : std::max(256, 48 * static_cast<int>(count));
    w.collision =
        std::make_unique<Collision>(static_cast<int>(count), std::max(64, max_contacts / 2));
    w.groups = std::make_unique<Groups>(count);
    w.sleep = std::make_unique<SleepKeeper>(count);
    w.sequential_impulse.reserve(static_cast<int>(count), max_contacts);
    w.awake.reserve(count);
    w.can_move.reserve(count);
    w.grouped_bodies.reserve(count);
    w.batch_bodies.reserve(count);
    w.grouped_contacts.reserve(static_cast<size_t>(max_contacts));
    w.batch_contacts.reserve(static_cast<size_t>(max_contacts));
    contacts_.reserve(static_cast<size_t>(max_contacts));
    states_.resize(count);
    w.friction.resize(count * count);
    for (size_t i = 0; i < count; ++i) {
        Impl::Item& item = w.items[i];
        w.collision->add(*item.body, item.can_move);
        if (item.can_move) w.can_move.push_back(i);
        w.read_state(i, states_[i]);
        states_[i].awake = item.can_move;
        for (size_t j = 0; j < count; ++j) {
            w.friction[i * count + j] = scene::pair_friction(w.scene(), item.name, item.friction,
                                                             w.items[j].name, w.items[j].friction);
        }
    }
    w.collect_awake(states_);
}

int World::size() const {
    return static_cast<int>(impl_->items.size());
}
int World::scene_size() const {
    return static_cast<int>(impl_->scene_.bodies.size());
}
const std::string& World::name(BodyIndex body) const {
    return impl_->items[static_cast<size_t>(body.value)].name;
}

BodyIndex World::find(const std::string& name) const {
    for (size_t i = 0; i < impl_->items.size(); ++i) {
        if (impl_->items[i].name == name) return {static_cast<int>(i)};
    }
    return {};
}

double World::friction(BodyIndex a, BodyIndex b) const {
    return impl_->friction[static_cast<size_t>(a.value) * impl_->items.size() +
                           static_cast<size_t>(b.value)];
}

std::span<const size_t> World::stepped() const {
    return impl_->awake;
}

double World::mass(BodyIndex body) const {
    return impl_->items[static_cast<size_t>(body.value)].body->getMass();
}

void World::set_mass(BodyIndex body, double mass) noexcept {
    btRigidBody& b = *impl_->items[static_cast<size_t>(body.value)].body;
    if (b.getMass() != mass) b.setMassProps(mass, b.getLocalInertia());
}

void World::set_velocity(BodyIndex body, const Vec3& v_WB) noexcept {
    impl_->items[static_cast<size_t>(body.value)].body->setLinearVelocity(to_bullet(v_WB));
}

void World::set_pose(BodyIndex body, const Pose& X_WB) noexcept {
    const auto i = static_cast<size_t>(body.value);
    Impl::Item& item = impl_->items[i];
    item.body->setWorldTransform(to_bullet(X_WB * item.X_BM));
    item.body->updateInertiaTensor();
    item.body->setLinearVelocity({0, 0, 0});
    item.body->setAngularVelocity({0, 0, 0});
    if (item.can_move) impl_->wake(i, states_);
    impl_->read_state(i, states_[i]);
}

void World::apply(BodyIndex body, const Vec3& force_W, const Vec3& torque_W) noexcept {
    const auto i = static_cast<size_t>(body.value);
    Impl::Item& item = impl_->items[i];
    if (!item.can_move) return;
    item.force += force_W;
    item.torque += torque_W;
    impl_->wake(i, states_);
}

StepStatus World::step(double h) noexcept {
    Impl& w = *impl_;
    w.collect_awake(states_);
    w.integrate_loads(h, gravity_);
    w.collision->find_contacts(h);
    w.collect_awake(states_);  // some may have woken
    w.prepare_contacts();
    w.group_contacts();
    stats_ = w.solve(h);
    w.integrate_positions(h, states_);

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
        }
    }
    w.let_sleep(h, states_);
    return status;
}

void World::Impl::wake(size_t i, std::vector<BodyState>& states) {
    states[i].awake = true;
    if (!sleep) return;  // not yet active
    sleep->stir(i);
    if (!is_awake(i)) collision->sleepers_changed();
    items[i].body->setUserIndex2(kAwake);
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
        if (!item.is_proxy) acceleration += gravity;
        body.setLinearVelocity(body.getLinearVelocity() +
                               h * to_bullet(acceleration) * body.getLinearFactor());
        const btVector3 turn = body.getInvInertiaTensorWorld() * to_bullet(item.torque);
        const btVector3 gyroscopic = body.getAngularFactor().isZero()
                                         ? btVector3(0, 0, 0)
                                         : body.computeGyroscopicImpulseImplicit_Body(h);
        body.setAngularVelocity(body.getAngularVelocity() +
                                (h * turn + gyroscopic) * body.getAngularFactor());
        item.force.setZero();
        item.torque.setZero();
        // what contacts are looked for ahead of
        body.setInterpolationLinearVelocity(body.getLinearVelocity());
        collision->update_bounds(body, h);
    }
}

void World::Impl::prepare_contacts() {
    const size_t count = items.size();
    for (btPersistentManifold* manifold : collision->manifolds()) {
        const auto a = static_cast<size_t>(manifold->getBody0()->getUserIndex());
        const auto b = static_cast<size_t>(manifold->getBody1()->getUserIndex());
        for (int i = 0; i < manifold->getNumContacts(); ++i) {
            manifold->getContactPoint(i).m_combinedFriction = friction[a * count + b];
        }
        even_out(*manifold);
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
    const auto solve_batch = [&] {
        if (batch_contacts.empty()) return;
        const contact::SolveStats batch = sequential_impulse.solve(
            batch_bodies, batch_contacts, settings, h, collision->dispatcher());
        stats.iterations = std::max(stats.iterations, batch.iterations);
        stats.residual = std::max(stats.residual, batch.residual);
        batch_bodies.clear();
        batch_contacts.clear();
    };
    auto body = grouped_bodies.begin();
    auto contact = grouped_contacts.begin();
    while (contact != grouped_contacts.end()) {
        const size_t group = contact->group;
        while (body->group < group) ++body;  // these touch nothing
        const auto first_body = body;
        bool has_finger = false;
        for (; body != grouped_bodies.end() && body->group == group; ++body) {
            has_finger = has_finger || items[static_cast<size_t>(body->order)].is_proxy;
        }
        // a held object takes many iterations: nothing else shall wait for it
        if (has_finger) solve_batch();
        for (auto b = first_body; b != body; ++b) batch_bodies.push_back(b->item);
        for (; contact != grouped_contacts.end() && contact->group == group; ++contact) {
            batch_contacts.push_back(contact->item);
        }
        if (has_finger || batch_contacts.size() >= kBatch) solve_batch();
    }
    solve_batch();
    return stats;
}

void World::Impl::integrate_positions(double h, std::vector<BodyState>& states) {
    for (const size_t i : awake) {
        btRigidBody& body = *items[i].body;
        btTransform next;
        btTransformUtil::integrateTransform(body.getWorldTransform(), body.getLinearVelocity(),
                                            body.getAngularVelocity(), h, next);
        body.setWorldTransform(next);
        body.updateInertiaTensor();
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
            sleep->stir(i);  // so that nothing that a finger touches may sleep
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
