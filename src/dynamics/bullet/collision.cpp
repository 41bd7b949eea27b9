#include "dynamics/bullet/collision.h"

#include "dynamics/bullet/carried.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>

namespace dihaptic::dynamics {
namespace {

/// Bodies may leave this cube, but the broadphase then finds more pairs than necessary.
constexpr double kWorldHalfExtent = 10.0;  // [m]
/// Pairs of bodies are found at this distance before they touch.
constexpr double kApproach = 3e-3;  // [m]
/// Bullet finds contacts between hulls with many edges at this distance before the hulls touch, and
/// at a larger distance if the bodies could approach each other by more in the step.
constexpr double kHullMargin = 2e-3;      // [m]
constexpr double kMostHullMargin = 5e-2;  // [m]

/// Maximum stride in the search for bodies that enter each other. A stride is also no longer than
/// half of the combined thickness of the two bodies, so that no body can enter and leave the other
/// unseen [m].
constexpr double kStride = 2e-3;
constexpr double kMostStrides = 256;

/// Cost of one stride for two shapes [visits]: the number of potential separating axes between
/// polyhedra, times the number of vertices.
int64_t stride_visits(const CollisionPart& a, const CollisionPart& b) {
    constexpr int64_t kFewest = 100;  // for two boxes, and for round shapes
    constexpr int64_t kProductsPerVisit = 20;
    const Polyhedron* p = a.polyhedron.get();
    const Polyhedron* q = b.polyhedron.get();
    if (p == nullptr || q == nullptr) return kFewest;
    const size_t axes =
        p->faces.size() + q->faces.size() + p->directions.size() * q->directions.size();
    const auto products = static_cast<int64_t>(axes * (p->vertices.size() + q->vertices.size()));
    return std::max(kFewest, products / kProductsPerVisit);
}

/// Largest speed due to rotation of any point of a body's part; the body's centre may lie anywhere
/// [m/s].
double turning(const CollisionPart& part, const btTransform& X_WS) {
    const btScalar speed = part.body->getInterpolationAngularVelocity().length();
    if (speed == 0) return 0;
    const btVector3 off = X_WS * part.centre - part.body->getWorldTransform().getOrigin();
    return speed * (off.length() + part.radius);
}

/// Moves a body for a time t at its current velocities.
void move_on(btRigidBody& body, const btTransform& from, double t) {
    btTransform to;
    btTransformUtil::integrateTransform(from, body.getLinearVelocity(), body.getAngularVelocity(),
                                        t, to);
    body.setWorldTransform(to);
}

/// Converts a contact found at time t into an equivalent contact at the start of the step, when
/// body 0 was at from_0 and body 1 at from_1. The gap of the new contact is such that the current
/// velocities lead to the gap found at t. Returns whether the gap at t is below -kEntered and these
/// velocities violate the contact by more than kEntered, given that the fraction `recovery` of a
/// penetration is removed.
bool look_back(const btPersistentManifold& manifold, btManifoldPoint& point,
               const btTransform& from_0, const btTransform& from_1, double t, double h,
               double recovery) {
    const btRigidBody& body_0 = *btRigidBody::upcast(manifold.getBody0());
    const btRigidBody& body_1 = *btRigidBody::upcast(manifold.getBody1());
    const btVector3 at = 0.5 * (point.m_positionWorldOnA + point.m_positionWorldOnB);
    // a point moves on an arc about the body's centre; the chord of this arc is perpendicular to
    // the mean of the point's arms at its two ends
    const auto mean_arm = [&](const btRigidBody& body, const btTransform& from) {
        const btTransform& to = body.getWorldTransform();
        const btVector3 arm = at - to.getOrigin();
        return 0.5 * (arm + from.getBasis() * (to.getBasis().transpose() * arm));
    };
    const btVector3 where = 0.5 * (from_0.getOrigin() + mean_arm(body_0, from_0) +
                                   from_1.getOrigin() + mean_arm(body_1, from_1));
    const auto velocity = [&](const btRigidBody& body, const btTransform& from) {
        return body.getLinearVelocity() + body.getAngularVelocity().cross(where - from.getOrigin());
    };
    const btScalar apart =
        point.m_normalWorldOnB.dot(velocity(body_0, from_0) - velocity(body_1, from_1));
    const bool entered = point.m_distance1 < -kEntered;
    point.m_distance1 -= t * apart;
    point.m_positionWorldOnA = where;
    point.m_positionWorldOnB = where;
    const double share = point.m_distance1 < 0 ? recovery : 1;
    return entered && share * point.m_distance1 + h * apart < -kEntered;
}

/// The smallest gap of a manifold's contacts, or zero if all gaps are positive [m].
double depth_of(const btPersistentManifold& manifold) {
    double least = 0;
    for (int i = 0; i < manifold.getNumContacts(); ++i)
        least = std::min<double>(least, manifold.getContactPoint(i).m_distance1);
    return least;
}

/// Whether the contacts between two touching bodies are soft.
bool is_soft(const btPersistentManifold& manifold) {
    if (manifold.getNumContacts() == 0) return false;
    const btManifoldPoint& point = manifold.getContactPoint(0);
    return point.m_userPersistentData != nullptr && carried(point).law.stiffness > 0;
}

enum Group { kMovable = 1, kImmovable = 2 };

btDefaultCollisionConstructionInfo pools(int max_pairs) {
    btDefaultCollisionConstructionInfo info;
    info.m_customCollisionAlgorithmMaxElementSize = 256;
    info.m_defaultMaxPersistentManifoldPoolSize = max_pairs;
    info.m_defaultMaxCollisionAlgorithmPoolSize = max_pairs + 1;  // 1 extra for find_entered()
    return info;
}

}  // namespace

double approach(const CollisionPart& a, const CollisionPart& b, double h) {
    const btVector3 closing =
        a.body->getInterpolationLinearVelocity() - b.body->getInterpolationLinearVelocity();
    return h * (closing.length() + a.turning + b.turning);
}

Collision::Collision(int max_parts, int max_pairs)
    : configuration_(pools(max_pairs)),
      dispatcher_(&configuration_, max_pairs),
      algorithms_(dispatcher_, step_),
      broadphase_(btVector3(-kWorldHalfExtent, -kWorldHalfExtent, -kWorldHalfExtent),
                  btVector3(kWorldHalfExtent, kWorldHalfExtent, kWorldHalfExtent),
                  static_cast<unsigned>(max_parts + 2), &pairs_, true),
      max_pairs_(max_pairs) {
    // find contacts at the distance set here, whatever the size of the shapes
    dispatcher_.setDispatcherFlags(
        dispatcher_.getDispatcherFlags() &
        ~btCollisionDispatcher::CD_USE_RELATIVE_CONTACT_BREAKING_THRESHOLD);
    manifolds_.reserve(static_cast<size_t>(max_pairs) + kMostEntered);
    found_.reserve(static_cast<size_t>(max_pairs) + kMostEntered);
    looked_at_.reserve(static_cast<size_t>(max_pairs));
    live_.reserve(static_cast<size_t>(max_pairs));
    sorting_.reserve(static_cast<size_t>(max_pairs));
    scratch_.reserve(8);
    parts_.reserve(static_cast<size_t>(max_parts));
    new_.reserve(kMostEntered);
    for (size_t i = 0; i < kMostEntered; ++i) {
        entered_.push_back(std::make_unique<btPersistentManifold>());
        // Bullet's constructor does not set this threshold
        entered_.back()->setContactBreakingThreshold(BT_LARGE_FLOAT);
    }
    reserve_pairs(max_pairs);
    pairs_.setOverlapFilterCallback(&other_bodies_);
}

Collision::~Collision() {
    for (const CollisionPart* part : parts_) {
        pairs_.cleanProxyFromPairs(part->bounds, &dispatcher_);
        broadphase_.destroyProxy(part->bounds, &dispatcher_);
    }
}

void Collision::reserve_pairs(int pairs) {
    // The tables of the pair cache only grow, and never shrink: fill the cache once and empty it.
    std::vector<btBroadphaseProxy> dummies(static_cast<size_t>(pairs) + 1);
    for (size_t i = 0; i < dummies.size(); ++i) {
        dummies[i].m_uniqueId = static_cast<int>(i) + 1;
        dummies[i].m_collisionFilterGroup = kMovable;
        dummies[i].m_collisionFilterMask = kMovable;
    }
    for (size_t i = 1; i < dummies.size(); ++i) pairs_.addOverlappingPair(&dummies[0], &dummies[i]);
    for (size_t i = 1; i < dummies.size(); ++i)
        pairs_.removeOverlappingPair(&dummies[0], &dummies[i], &dispatcher_);
}

void Collision::add(CollisionPart& part, bool can_move) {
    btVector3 low;
    btVector3 high;
    part.shape->getAabb(part.X_WS(), low, high);
    part.bounds = broadphase_.createProxy(
        low, high, part.shape->getShapeType(), &part, can_move ? kMovable : kImmovable,
        can_move ? kMovable | kImmovable : kMovable, &dispatcher_);
    several_parts_ = several_parts_ || (!parts_.empty() && parts_.back()->body == part.body);
    parts_.push_back(&part);
}

void Collision::update_bounds(CollisionPart& part, double h) {
    set_bounds(part, h, false);
}

void Collision::widen_bounds(CollisionPart& part, double h) {
    set_bounds(part, h, true);
}

void Collision::set_bounds(CollisionPart& part, double h, bool keep) {
    btVector3 low;
    btVector3 high;
    const btTransform X_WS = part.X_WS();
    part.shape->getAabb(X_WS, low, high);
    const btVector3 travel = h * part.body->getInterpolationLinearVelocity();
    const double most = kApproach + h * turning(part, X_WS);
    const btVector3 margin = travel.absolute() + btVector3(most, most, most);
    low -= margin;
    high += margin;
    if (keep) {
        low.setMin(part.bounds->m_aabbMin);
        high.setMax(part.bounds->m_aabbMax);
    }
    broadphase_.setAabb(part.bounds, low, high, &dispatcher_);
}

void Collision::hide(CollisionPart& part) {
    part.hidden = true;
    // moves the part's bounds away from all bodies, so that its pairs are dropped
    const btVector3 corner(kWorldHalfExtent, kWorldHalfExtent, kWorldHalfExtent);
    broadphase_.setAabb(part.bounds, corner, corner, &dispatcher_);
}

void Collision::forget() {
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i)
        dispatcher_.getManifoldByIndexInternal(i)->clearManifold();
    manifolds_.clear();
}

void Collision::find_contacts(double h) {
    search_was_cut_ = is_unsure_ = false;
    step_ = h;
    ++placing_;
    ++timing_;
    btDispatcherInfo info;
    info.m_timeStep = h;
    manifolds_.clear();
    found_.clear();
    entered_count_ = 0;

    btBroadphasePairArray& pairs = pairs_.getOverlappingPairArray();
    const auto count = static_cast<size_t>(pairs.size());
    overflowed_ = count > static_cast<size_t>(max_pairs_);
    looked_at_.assign(count, false);
    bool woke = true;
    while (woke) {
        woke = false;
        if (live_is_stale_ || live_version_ != pairs_.version) list_live_pairs();
        for (const int i : live_) {
            if (looked_at_[static_cast<size_t>(i)]) continue;
            looked_at_[static_cast<size_t>(i)] = true;
            if (look_at(pairs[i], info)) woke = true;
        }
        live_is_stale_ = woke;
    }
    if (!several_parts_) return;
    sort_by_bodies();
    remove_inner();
}

void Collision::sort_by_bodies() {
    sorting_.clear();
    for (const OfParts& of : found_) {
        sorting_.push_back(
            {{of.manifold->getBody0()->getUserIndex(), of.manifold->getBody1()->getUserIndex(),
              static_cast<int>(sorting_.size())},
             of});
    }
    std::sort(sorting_.begin(), sorting_.end(),
              [](const OfBodies& a, const OfBodies& b) { return a.key < b.key; });
    for (size_t i = 0; i < sorting_.size(); ++i) found_[i] = sorting_[i].of;
}

void Collision::remove_inner() {
    const auto same_bodies = [](const OfParts& a, const OfParts& b) {
        return a.manifold->getBody0() == b.manifold->getBody0() &&
               a.manifold->getBody1() == b.manifold->getBody1();
    };
    for (size_t from = 0; from < found_.size();) {
        size_t to = from + 1;
        while (to < found_.size() && same_bodies(found_[from], found_[to])) ++to;
        if (to - from > 1) remove_inner_contacts(std::span(found_).subspan(from, to - from));
        from = to;
    }
    manifolds_.clear();
    for (const OfParts& of : found_) {
        if (of.manifold->getNumContacts() > 0) manifolds_.push_back(of.manifold);
    }
}

OwnAlgorithm* Collision::own(const btBroadphasePair& pair) {
    const bool is_own = part(pair.m_pProxy0).is_own() && part(pair.m_pProxy1).is_own();
    return is_own ? static_cast<OwnAlgorithm*>(pair.m_algorithm) : nullptr;
}

void Collision::place(CollisionPart& part) const {
    if (part.placing == placing_) return;
    const btTransform X_WS = part.X_WS();
    const bool first = part.placing == 0;
    part.placing = placing_;
    if (!first && X_WS == part.placed_at) return;
    const Pose last = part.X_WS_placed;
    part.placed_at = X_WS;
    part.X_WS_placed = from_bullet(X_WS);
    if (first) return;
    const Pose& now = part.X_WS_placed;
    const Vec3 centre = from_bullet(part.centre);
    // a point at the distance r from the axis of a turn by an angle moves by 2 r sin(angle / 2)
    part.way += (now * centre - last * centre).norm() +
                2 * (now.R * last.R.conjugate()).vec().norm() * part.radius;
}

void Collision::time(CollisionPart& part) const {
    if (part.timing == timing_) return;
    part.timing = timing_;
    part.turning = turning(part, part.X_WS());
}

void Collision::list_live_pairs() {
    const auto awake = [](const btBroadphaseProxy* proxy) {
        return part(proxy).body->getUserIndex2() == kAwake;
    };
    live_.clear();
    btBroadphasePairArray& pairs = pairs_.getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i) {
        if (awake(pairs[i].m_pProxy0) || awake(pairs[i].m_pProxy1)) live_.push_back(i);
    }
    live_version_ = pairs_.version;
    live_is_stale_ = false;
}

bool Collision::look_at(btBroadphasePair& pair, const btDispatcherInfo& info) {
    CollisionPart& part_a = part(pair.m_pProxy0);
    CollisionPart& part_b = part(pair.m_pProxy1);
    for (CollisionPart* each : {&part_a, &part_b}) {
        place(*each);
        time(*each);
    }
    OwnAlgorithm* const known = own(pair);
    if (known != nullptr && known->stay_apart(part_a, part_b)) return false;
    if (known != nullptr && may_be_carried(part_a, part_b) && known->carry(part_a, part_b)) {
        scratch_.resizeNoInitialize(0);
    } else if (!examine(pair, part_a, part_b, info)) {
        return false;
    }
    pair.m_algorithm->getAllContactManifolds(scratch_);
    return list_found(part_a, part_b);
}

bool Collision::may_be_carried(const CollisionPart& a, const CollisionPart& b) {
    const auto may = [](const CollisionPart& one) {
        return one.body->isStaticObject() || one.body->getUserIndex3() == kInHeap;
    };
    return may(a) && may(b);
}

bool Collision::examine(btBroadphasePair& pair, const CollisionPart& part_a,
                        const CollisionPart& part_b, const btDispatcherInfo& info) {
    btCollisionObject& a = *part_a.body;
    btCollisionObject& b = *part_b.body;
    const btCollisionObjectWrapper a_wrap(nullptr, part_a.shape.get(), &a, part_a.placed_at, -1,
                                          -1);
    const btCollisionObjectWrapper b_wrap(nullptr, part_b.shape.get(), &b, part_b.placed_at, -1,
                                          -1);
    // contacts between convex hulls are found before the hulls touch; Bullet derives the distance
    // at which that happens from three settings
    const double margin = std::min(kMostHullMargin, kHullMargin + approach(part_a, part_b, step_));
    dispatcher_.margin = margin;
    scratch_.resizeNoInitialize(0);
    if (pair.m_algorithm == nullptr) {
        pair.m_algorithm =
            dispatcher_.findAlgorithm(&a_wrap, &b_wrap, nullptr, BT_CONTACT_POINT_ALGORITHMS);
        if (pair.m_algorithm == nullptr) return false;
    } else {
        pair.m_algorithm->getAllContactManifolds(scratch_);
        for (int m = 0; m < scratch_.size(); ++m) scratch_[m]->setContactBreakingThreshold(margin);
        scratch_.resizeNoInitialize(0);
    }
    btManifoldResult result(&a_wrap, &b_wrap);
    result.m_closestPointDistanceThreshold = margin;
    pair.m_algorithm->processCollision(&a_wrap, &b_wrap, info, &result);
    return true;
}

bool Collision::list_found(const CollisionPart& part_a, const CollisionPart& part_b) {
    btCollisionObject& a = *part_a.body;
    btCollisionObject& b = *part_b.body;
    bool woke = false;
    for (int m = 0; m < scratch_.size(); ++m) {
        if (scratch_[m]->getNumContacts() == 0) continue;
        manifolds_.push_back(scratch_[m]);
        const bool in_order = scratch_[m]->getBody0() == &a;
        found_.push_back({scratch_[m], in_order ? &part_a : &part_b, in_order ? &part_b : &part_a});
        if (a.isStaticObject() || b.isStaticObject()) continue;
        for (btCollisionObject* object : {&a, &b}) {
            if (object->getUserIndex2() == kAwake) continue;
            object->setUserIndex2(kAwake);
            woke = true;
        }
    }
    return woke;
}

bool Collision::find_entered(double h, double recovery, contact::Work& work) {
    if (live_is_stale_ || live_version_ != pairs_.version) list_live_pairs();
    ++timing_;
    new_.clear();
    for (const int i : live_) {
        if (entered_count_ == entered_.size() || search_was_cut_) break;
        btPersistentManifold& out = *entered_[entered_count_];
        if (!enters(pairs_.getOverlappingPairArray()[i], h, recovery, out, work)) continue;
        ++entered_count_;
        manifolds_.push_back(&out);
        new_.push_back(&out);
        for (const btCollisionObject* object : {out.getBody0(), out.getBody1()}) {
            auto& body = const_cast<btCollisionObject&>(*object);
            if (body.isStaticObject() || body.getUserIndex2() == kAwake) continue;
            body.setUserIndex2(kAwake);
            live_is_stale_ = true;
        }
    }
    if (new_.empty()) return false;
    sort_by_bodies();
    return true;
}

bool Collision::affords(contact::Work& work, int64_t visits) {
    search_was_cut_ = !work.affords(visits);
    if (!search_was_cut_) work.spend(visits);
    return !search_was_cut_;
}

const btPersistentManifold* Collision::manifold_of(const btBroadphasePair& pair) {
    scratch_.resizeNoInitialize(0);
    if (pair.m_algorithm != nullptr) pair.m_algorithm->getAllContactManifolds(scratch_);
    return scratch_.size() > 0 ? scratch_[0] : nullptr;
}

bool Collision::meet(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                     btPersistentManifold& out) {
    out.clearManifold();
    btCollisionAlgorithm* algorithm =
        dispatcher_.findAlgorithm(&a, &b, &out, BT_CONTACT_POINT_ALGORITHMS);
    if (algorithm == nullptr) return false;
    btManifoldResult result(&a, &b);
    result.m_closestPointDistanceThreshold = kHullMargin;
    algorithm->processCollision(&a, &b, btDispatcherInfo(), &result);
    algorithm->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(algorithm);
    return true;
}

template <class Visit>
double Collision::walk(btBroadphasePair& pair, double h, int first, btPersistentManifold& out,
                       contact::Work& work, const Visit& visit) {
    CollisionPart& part_a = part(pair.m_pProxy0);
    CollisionPart& part_b = part(pair.m_pProxy1);
    time(part_a);
    time(part_b);
    const double way = approach(part_a, part_b, h);
    if (!(way > kEntered)) return 1;  // also true if `way` is not a number
    btRigidBody& a = *btRigidBody::upcast(part_a.body);
    btRigidBody& b = *btRigidBody::upcast(part_b.body);
    const btTransform from_a = a.getWorldTransform();
    const btTransform from_b = b.getWorldTransform();
    btTransform X_WA = part_a.X_WS();
    btTransform X_WB = part_b.X_WS();
    const btCollisionObjectWrapper a_wrap(nullptr, part_a.shape.get(), &a, X_WA, -1, -1);
    const btCollisionObjectWrapper b_wrap(nullptr, part_b.shape.get(), &b, X_WB, -1, -1);
    const btPersistentManifold* known = manifold_of(pair);
    // bodies may enter soft bodies, to the depth that their contact allows
    if (known != nullptr && is_soft(*known)) return 1;
    const bool swapped = known != nullptr && known->getBody0() != &a;
    out.setBodies(swapped ? &b : &a, swapped ? &a : &b);
    const double stride = std::min(kStride, (part_a.thickness + part_b.thickness) / 2);
    const auto strides = static_cast<int>(std::clamp(std::ceil(way / stride), 1.0, kMostStrides));
    const int64_t visits = stride_visits(part_a, part_b);
    const auto found_at = [&](double share) {
        move_on(a, from_a, share * h * a.getHitFraction());
        move_on(b, from_b, share * h * b.getHitFraction());
        X_WA = part_a.X_WS();
        X_WB = part_b.X_WS();
        if (!meet(a_wrap, b_wrap, out)) return false;
        return visit(swapped ? from_b : from_a, swapped ? from_a : from_b, share * h);
    };
    double free = 0;
    double met = 2;
    for (int k = first; k <= strides && met > 1 && affords(work, visits); ++k) {
        const double share = static_cast<double>(k) / strides;
        (found_at(share) ? met : free) = share;
    }
    a.setWorldTransform(from_a);
    b.setWorldTransform(from_b);
    return met <= 1 ? free : 1;
}

bool Collision::enters(btBroadphasePair& pair, double h, double recovery, btPersistentManifold& out,
                       contact::Work& work) {
    return walk(pair, h, 1, out, work,
                [&](const btTransform& from_0, const btTransform& from_1, double t) {
                    bool found = false;
                    const bool is_in = depth_of(out) < -kEntered;
                    for (int i = 0; i < out.getNumContacts(); ++i)
                        found |=
                            look_back(out, out.getContactPoint(i), from_0, from_1, t, h, recovery);
                    is_unsure_ = is_unsure_ || (is_in && !found);
                    return found;
                }) < 1;
}

bool Collision::hold_back(double h, contact::Work& work) {
    if (live_is_stale_ || live_version_ != pairs_.version) list_live_pairs();
    ++timing_;
    btPersistentManifold& out = waiting_;
    const auto keep_out = [&](btBroadphasePair& pair) {
        double at_first = 0;
        const double share =
            walk(pair, h, 0, out, work, [&](const btTransform&, const btTransform&, double t) {
                const double now = depth_of(out);
                if (t == 0) at_first = now;
                return now < at_first - kEntered;
            });
        const bool is_in = at_first < -kEntered;
        if (share == 1 || (is_in && share == 0)) return false;
        for (const btBroadphaseProxy* proxy : {pair.m_pProxy0, pair.m_pProxy1})
            part(proxy).body->setHitFraction(share * part(proxy).body->getHitFraction());
        return true;
    };
    bool found = false;
    for (const int i : live_) {
        if (keep_out(pairs_.getOverlappingPairArray()[i])) found = true;
        if (search_was_cut_) break;
    }
    return found;
}

}  // namespace dihaptic::dynamics
