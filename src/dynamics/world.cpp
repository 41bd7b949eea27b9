#include "dynamics/world.h"

#include <algorithm>
#include <cassert>

#include "dynamics/world_impl.h"
#include "scene/solid.h"

namespace dihaptic::dynamics {
namespace {

/// Replaces the moments of inertia of a solid by their mean about B, and makes B its mass frame.
void lump(scene::Solid& solid) {
    const double about_centre = solid.inertia.sum() / 3;
    solid.inertia.setConstant(about_centre + 2 * solid.mass / 3 * solid.X_BM.p.squaredNorm());
    solid.X_BM = {};
}

}  // namespace

void World::Impl::add(const std::string& name, const scene::Shape& shape, double mass,
                      double friction_coefficient, double torsion_radius, const Pose& X_WB,
                      const Vec3& moves, const Vec3& turns, bool about_origin) {
    Item item;
    item.name = name;
    item.friction = friction_coefficient;
    item.torsion_radius = torsion_radius;
    item.can_move = mass > 0 && !(moves.isZero() && turns.isZero());
    scene::Solid solid = scene::solid_of(shape, item.can_move ? mass : 0);
    if (about_origin) lump(solid);
    item.X_BM = solid.X_BM;
    item.inertia = solid.inertia;
    item.mass = solid.mass;
    item.moves = moves;
    item.turns = turns;
    item.parts = collision_parts(shape, item.X_BM);

    btRigidBody::btRigidBodyConstructionInfo info(
        solid.mass, nullptr, item.parts.front()->shape.get(), to_bullet(item.inertia));
    info.m_startWorldTransform = to_bullet(X_WB * item.X_BM);
    item.body = std::make_unique<btRigidBody>(info);
    for (const auto& part : item.parts) part->body = item.body.get();
    item.body->setUserIndex(static_cast<int>(items.size()));
    item.body->setUserIndex2(item.can_move ? kAwake : 0);
    if (item.can_move) item.body->setActivationState(DISABLE_DEACTIVATION);
    items.push_back(std::move(item));
}

namespace {

/// Lets two bodies pass through each other.
void let_pass(btRigidBody& a, btRigidBody& b) {
    a.setIgnoreCollisionCheck(&b, true);
    b.setIgnoreCollisionCheck(&a, true);
}

}  // namespace

void World::Impl::add(const scene::Joint& joint) {
    const auto side = [&](size_t i) -> Joints::Side {
        const int at = scene.find(joint.between[i]);
        Item& item = items[static_cast<size_t>(at)];
        return {item.body.get(), !item.can_move, at};
    };
    const bool to_world = joint.between.size() == 1;
    const Joints::Side a = to_world ? Joints::Side{} : side(0);
    const Joints::Side b = side(to_world ? 0 : 1);
    joints.add(joint, a, b);
    if (a.body == nullptr || joint.lets_touch()) return;
    let_pass(*a.body, *b.body);
}

void World::Impl::part_groups() {
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        for (size_t k = 0; k < i; ++k) {
            const std::string& group = scene.bodies[i].group;
            if (group.empty() || group != scene.bodies[k].group) continue;
            let_pass(*items[i].body, *items[k].body);
        }
    }
}

World::World(const scene::Scene& scene, const frame::DynamicsSettings& settings)
    : impl_(std::make_unique<Impl>()), gravity_(scene.gravity) {
    impl_->scene = scene;
    impl_->settings = settings;
    for (const scene::Body& body : scene.bodies) {
        // driven bodies move as if their mass were infinite: see inverse_mass_of()
        const double mass = body.fixed ? 0 : body.driven ? 1 : scene::mass(body);
        impl_->add(body.name, body.shape, mass, body.friction, body.torsion_radius, body.pose(),
                   body.fixed ? Vec3::Zero() : factors(body.moves),
                   body.fixed ? Vec3::Zero() : factors(body.turns));
        impl_->items.back().is_driven = body.driven;
        impl_->items.back().set_surface(body.surface);
    }
    for (const scene::Joint& joint : scene.joints) impl_->add(joint);
    impl_->recorded_joints = scene::recorded_joints(scene).size();
    impl_->part_groups();
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

BodyIndex World::add_proxy(const scene::Finger& finger, const Vec3& p_WP, bool turns) {
    impl_->add(finger.name, finger.shape, finger.mass, finger.friction, finger.torsion_radius,
               {rotation_xyz(finger.rotation), p_WP}, Vec3::Ones(), Vec3::Constant(turns ? 1 : 0),
               turns);
    impl_->items.back().set_surface(finger.surface);
    impl_->items.back().is_proxy = true;
    return {size() - 1};
}

BodyIndex World::add_changeable_proxy(const scene::Finger& finger, const Vec3& p_WP, bool turns) {
    const BodyIndex proxy = add_proxy(finger, p_WP, turns);
    impl_->items.back().may_be_point = true;
    return proxy;
}

void World::set_point(BodyIndex proxy, bool point) noexcept {
    Impl& w = *impl_;
    Impl::Item& item = w.items[static_cast<size_t>(proxy.value)];
    assert(item.may_be_point);
    item.is_point = point;
    if (!w.collision) return;  // not yet activated
    for (const auto& part : item.parts) {
        if (point) {
            w.collision->hide(*part);
        } else {
            w.collision->show(*part);
        }
    }
}

BodyIndex World::add_point(const scene::Finger& finger, const Vec3& p_WP, bool turns) {
    // a point has no shape, but its Bullet body needs one
    impl_->add(finger.name, scene::Shape::sphere(scene::kSmallest), finger.mass, finger.friction,
               finger.torsion_radius, {rotation_xyz(finger.rotation), p_WP}, Vec3::Ones(),
               Vec3::Constant(turns ? 1 : 0), turns);
    impl_->items.back().set_surface(finger.surface);
    impl_->items.back().is_proxy = true;
    impl_->items.back().is_point = true;
    return {size() - 1};
}

void World::Impl::reserve_bodies(size_t count) {
    awake.reserve(count);
    placed.reserve(count);
    stepped.reserve(count);
    can_move.reserve(count);
    inverse_mass.resize(count);
    by_loads.assign(count, contact::Vec6::Zero());
    books.reserve(count, joints.size());
    bodies_of_islands.reserve(count);
    holds_finger.resize(count);
    island_bodies.reserve(count);
    island_change.reserve(count);
    joints_of_islands.reserve(joints.size());
    island_joints.reserve(joints.size());
}

void World::activate() {
    Impl& w = *impl_;
    const size_t count = w.items.size();
    int parts = 0;
    for (const Impl::Item& item : w.items) parts += static_cast<int>(item.parts.size());
    const int max_contacts =
        w.settings.max_contacts > 0 ? w.settings.max_contacts : std::max(256, 48 * parts);
    w.collision = std::make_unique<Collision>(parts, std::max(64, max_contacts / 2));
    w.groups = std::make_unique<Groups>(count);
    w.sleep = std::make_unique<SleepKeeper>(count);
    std::vector<double> torsion_radii;
    for (const Impl::Item& item : w.items) torsion_radii.push_back(item.torsion_radius);
    const bool torsion = *std::max_element(torsion_radii.begin(), torsion_radii.end()) > 0;
    const size_t elements = w.joints.elements();
    w.problem.reserve(std::move(torsion_radii), max_contacts, elements);
    w.solvers.reserve(static_cast<int>(count), max_contacts, torsion, static_cast<int>(elements));
    w.reserve_bodies(count);
    const auto points =
        static_cast<int>(std::count_if(w.items.begin(), w.items.end(), [](const Impl::Item& item) {
            return item.is_point || item.may_be_point;
        }));
    w.point_contacts.reserve(points);
    const size_t manifolds =
        static_cast<size_t>(max_contacts) + static_cast<size_t>(points) * kMostPointContacts;
    w.collision->manifolds().reserve(manifolds);
    w.contacts_of_islands.reserve(manifolds);
    w.island_contacts.reserve(manifolds);
    // points keep their records for two steps, and only a few are added late in a step
    w.carried_pool.reserve(MANIFOLD_CACHE_SIZE *
                           (static_cast<size_t>(w.collision->max_pairs()) + PathSearch::kMost +
                            2 * static_cast<size_t>(points) * kMostPointContacts));
    w.has_fingers = std::any_of(w.items.begin(), w.items.end(),
                                [](const Impl::Item& item) { return item.is_proxy; });
    contacts_.reserve(static_cast<size_t>(max_contacts));
    states_.resize(count);
    w.surfaces.resize(count * count);
    for (size_t i = 0; i < count; ++i) {
        Impl::Item& item = w.items[i];
        if (!item.is_point || item.may_be_point) {
            for (const auto& part : item.parts) w.collision->add(*part, item.can_move);
        }
        if (item.may_be_point) set_point({static_cast<int>(i)}, item.is_point);
        if (item.can_move) w.can_move.push_back(i);
        w.read_state(i, states_[i]);
        states_[i].awake = item.can_move;
        w.pair_surfaces(i);
    }
    w.collect_awake(states_);
}

scene::Surface World::Impl::surface_of(size_t i) const {
    scene::Surface out = items[i].surface;
    const BodyProperties& properties = items[i].properties;
    if (out.stiffness) *out.stiffness *= properties.stiffness;
    if (out.damping) *out.damping *= properties.stiffness;
    if (out.restitution)
        *out.restitution = std::min(1.0, *out.restitution * properties.restitution);
    return out;
}

void World::Impl::pair_surfaces(size_t i) {
    const Item& item = items[i];
    const scene::Surface own = surface_of(i);
    for (size_t j = 0; j < items.size(); ++j) {
        const scene::Surface other = surface_of(j);
        surfaces[i * items.size() + j] = surfaces[j * items.size() + i] = scene::pair_surface(
            scene, {item.name, item.friction, own}, {items[j].name, items[j].friction, other});
    }
}

int World::size() const {
    return static_cast<int>(impl_->items.size());
}
int World::scene_size() const {
    return static_cast<int>(impl_->scene.bodies.size());
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
    return impl_->friction_of(static_cast<size_t>(a.value), static_cast<size_t>(b.value));
}

double World::friction_at(BodyIndex a, BodyIndex b, const Vec3& p_W,
                          const Vec3& n_W) const noexcept {
    const auto i = static_cast<size_t>(a.value);
    const auto j = static_cast<size_t>(b.value);
    return impl_->friction_of(i, j) * impl_->relief_at(i, p_W, n_W).friction *
           impl_->relief_at(j, p_W, -n_W).friction;
}

const scene::PairSurface& World::surface(BodyIndex a, BodyIndex b) const {
    return impl_->surface_of(static_cast<size_t>(a.value), static_cast<size_t>(b.value));
}

std::span<const size_t> World::stepped() const {
    return impl_->stepped;
}

bool World::diverged() const noexcept {
    return impl_->diverged;
}

void World::mend() noexcept {
    Impl& w = *impl_;
    w.diverged = false;
    for (size_t i = 0; i < w.items.size(); ++i) {
        Impl::Item& item = w.items[i];
        item.force.setZero();
        item.torque.setZero();
        item.drive_to.reset();
        if (w.is_sound(i)) continue;
        // the position of a proxy will follow from its handle
        const Pose X_WB = i < w.scene.bodies.size() ? w.scene.bodies[i].pose() : Pose{};
        set_pose({static_cast<int>(i)}, X_WB);
    }
    for (const size_t i : w.can_move) w.wake(i, states_);
    w.collision->forget();
    w.point_contacts.forget();
    w.joints.forget();
}

void World::set_solver(contact::Solver solver) noexcept {
    impl_->settings.solver = solver;
}

contact::Solver World::solver() const noexcept {
    return impl_->settings.solver;
}

void World::watch_problems(ProblemWatcher watcher) {
    impl_->watcher = std::move(watcher);
}

std::span<const JointState> World::joints() const noexcept {
    return impl_->joints.states().first(impl_->recorded_joints);
}

const Balance& World::balance() const noexcept {
    return impl_->books.last();
}

bool World::held_back() const noexcept {
    return impl_->held_back;
}

double World::held_residual() const noexcept {
    return impl_->held_residual;
}

double World::mass(BodyIndex body) const {
    return impl_->items[static_cast<size_t>(body.value)].body->getMass();
}

void World::set_mass(BodyIndex body, double mass) noexcept {
    btRigidBody& b = *impl_->items[static_cast<size_t>(body.value)].body;
    if (b.getMass() != mass) b.setMassProps(mass, b.getLocalInertia());
}

void World::set_properties(BodyIndex body, const BodyProperties& properties) noexcept {
    const auto i = static_cast<size_t>(body.value);
    Impl::Item& item = impl_->items[i];
    if (item.properties == properties) return;
    item.properties = properties;
    if (item.relief)
        item.relief->scale(*item.texture, properties.texture_wavelength, properties.texture_height,
                           properties.texture_friction);
    if (!impl_->surfaces.empty()) impl_->pair_surfaces(i);
    if (!item.can_move) {  // bodies that lie on this one may slip now
        for (const size_t k : impl_->can_move) impl_->wake(k, states_);
        return;
    }
    item.body->setMassProps(item.mass, to_bullet(properties.turning * item.inertia));
    item.body->updateInertiaTensor();
    impl_->wake(i, states_);
}

void World::set_friction_scale(double scale) noexcept {
    impl_->friction_scale = scale;
    for (const size_t i : impl_->can_move) impl_->wake(i, states_);
}

double World::friction_scale() const noexcept {
    return impl_->friction_scale;
}

void World::set_velocity(BodyIndex body, const Vec3& v_WB) noexcept {
    const Impl::Item& item = impl_->items[static_cast<size_t>(body.value)];
    const Quat R_WB = from_bullet(item.body->getWorldTransform()).R * item.X_BM.R.conjugate();
    const Vec3 arm_W = R_WB * item.X_BM.p;
    const Vec3 w = from_bullet(item.body->getAngularVelocity());
    item.body->setLinearVelocity(to_bullet(v_WB + w.cross(arm_W)));
}

void World::set_motion(BodyIndex body, const Vec3& v_WB, const Vec3& w_WB) noexcept {
    const auto i = static_cast<size_t>(body.value);
    Impl::Item& item = impl_->items[i];
    if (!item.can_move || item.is_driven) return;
    item.body->setAngularVelocity(to_bullet(Vec3(w_WB.cwiseProduct(item.turns))));
    set_velocity(body, v_WB);
    const Vec3 v = from_bullet(item.body->getLinearVelocity());
    item.body->setLinearVelocity(to_bullet(Vec3(v.cwiseProduct(item.moves))));
    if (!impl_->is_sound(i)) impl_->diverged = true;
    impl_->wake(i, states_);
    impl_->read_state(i, states_[i]);
    impl_->joints.read();
}

double World::inertia(BodyIndex proxy) const {
    return impl_->items[static_cast<size_t>(proxy.value)].inertia.x();
}

void World::set_inertia(BodyIndex proxy, double inertia) noexcept {
    btRigidBody& b = *impl_->items[static_cast<size_t>(proxy.value)].body;
    b.setMassProps(b.getMass(), btVector3(inertia, inertia, inertia));
    b.updateInertiaTensor();
}

void World::set_angular_velocity(BodyIndex proxy, const Vec3& w_WP) noexcept {
    impl_->items[static_cast<size_t>(proxy.value)].body->setAngularVelocity(to_bullet(w_WP));
}

void World::carry(BodyIndex proxy, const Quat& R_WP, const Vec3& w_WP) noexcept {
    const auto i = static_cast<size_t>(proxy.value);
    btRigidBody& b = *impl_->items[i].body;
    const BodyState& state = states_[i];
    const Vec3 v_WP = state.v_WB;
    b.setWorldTransform(to_bullet(Pose{R_WP, state.X_WB.p} * impl_->items[i].X_BM));
    b.setAngularVelocity(to_bullet(w_WP));
    set_velocity(proxy, v_WP);
    impl_->read_state(i, states_[i]);
}

void World::set_pose(BodyIndex body, const Pose& X_WB) noexcept {
    const auto i = static_cast<size_t>(body.value);
    Impl::Item& item = impl_->items[i];
    if (item.can_move && !impl_->is_awake(i)) {  // bodies that lie on this one fall now
        for (const size_t k : impl_->can_move) impl_->wake(k, states_);
    }
    item.body->setWorldTransform(to_bullet(X_WB * item.X_BM));
    item.body->updateInertiaTensor();
    item.body->setLinearVelocity({0, 0, 0});
    item.body->setAngularVelocity({0, 0, 0});
    if (!impl_->is_sound(i)) impl_->diverged = true;  // steps skip fixed bodies
    if (item.can_move) {
        impl_->wake(i, states_);
    } else {
        impl_->place_fixed(i, states_);
    }
    impl_->read_state(i, states_[i]);
    impl_->joints.read();
}

void World::drive(BodyIndex body, const Pose& X_WB) noexcept {
    const auto i = static_cast<size_t>(body.value);
    if (!impl_->items[i].can_move) return;
    impl_->items[i].drive_to = X_WB;
    impl_->wake(i, states_);
}

void World::Impl::wake_sides(size_t joint, std::vector<BodyState>& states) {
    for (const Joints::Side& side : {joints.a(joint), joints.b(joint)}) {
        if (!side.fixed) wake(side.at(), states);
    }
}

void World::set_joint_properties(size_t joint, const JointProperties& properties) noexcept {
    if (impl_->joints.set(joint, properties)) impl_->wake_sides(joint, states_);
}

void World::drive_joint(size_t joint, const Motor& motor) noexcept {
    Joints& joints = impl_->joints;
    joints.drive(joint, motor);
    impl_->wake_sides(joint, states_);
    if (motor.push == 0) return;
    const auto push = [&](const Joints::Side& side, const contact::Vec6& along) {
        if (side.fixed) return;
        const contact::Vec6 load = motor.push * along;
        apply({side.item}, load.head<3>(), load.tail<3>());
    };
    const auto [of_a, of_b] = joints.along(joint);
    push(joints.a(joint), of_a);
    push(joints.b(joint), of_b);
}

void World::apply(BodyIndex body, const Vec3& force_W, const Vec3& torque_W) noexcept {
    const auto i = static_cast<size_t>(body.value);
    Impl::Item& item = impl_->items[i];
    if (!item.can_move) return;
    item.force += force_W;
    item.torque += torque_W;
    impl_->wake(i, states_);
}

void World::apply_at(BodyIndex body, const Vec3& force_W, const Vec3& p_W) noexcept {
    const btRigidBody& b = *impl_->items[static_cast<size_t>(body.value)].body;
    apply(body, force_W, (p_W - from_bullet(b.getCenterOfMassPosition())).cross(force_W));
}

void World::set_point(BodyIndex point, const Vec3& p_WP, const Vec3& v_WP) noexcept {
    BodyState& state = states_[static_cast<size_t>(point.value)];
    state.X_WB.p = p_WP;
    state.v_WB = v_WP;
    btRigidBody& body = *impl_->items[static_cast<size_t>(point.value)].body;
    body.getWorldTransform().setOrigin(to_bullet(p_WP));
    body.setLinearVelocity(to_bullet(v_WP));
}

void World::meet(BodyIndex point, const PointContact& contact) noexcept {
    const auto p = static_cast<size_t>(point.value);
    const auto b = static_cast<size_t>(contact.body.value);
    const Impl::Item& body = impl_->items[b];
    if (body.can_move) impl_->wake(b, states_);
    impl_->point_contacts.add(
        {body.body.get(), impl_->items[p].body.get(), contact.part, contact.face, contact.n_W,
         contact.gap,
         contact.friction_share *
             friction_at(contact.body, point,
                         from_bullet(impl_->items[p].body->getWorldTransform().getOrigin()),
                         contact.n_W),
         contact.compliance});
}

}  // namespace dihaptic::dynamics
