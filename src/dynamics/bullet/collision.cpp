#include "dynamics/bullet/collision.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>

namespace dihaptic::dynamics {
namespace {

/// Bodies may leave this cube; the broadphase then finds more pairs than it must.
constexpr double kWorldHalfExtent = 10.0;  // [m]
/// Pairs are found this much before they touch.
constexpr double kApproach = 3e-3;  // [m]
/// Bullet finds contacts of round shapes this much before they touch, and further for bodies that
/// could close more in the step.
constexpr double kRoundMargin = 2e-3;      // [m]
constexpr double kMostRoundMargin = 5e-2;  // [m]

/// Largest speed of a point of a body's part by its turning; the body's centre lies anywhere [m/s].
double turning(const btCollisionObject& body, const btCollisionShape& shape,
               const btTransform& X_WS) {
    const btScalar speed = body.getInterpolationAngularVelocity().length();
    if (speed == 0) return 0;
    btVector3 centre;
    btScalar radius = 0;
    shape.getBoundingSphere(centre, radius);
    const btVector3 off = X_WS * centre - body.getWorldTransform().getOrigin();
    return speed * (off.length() + radius);
}

double turning(const btCollisionObjectWrapper& part) {
    return turning(*part.getCollisionObject(), *part.getCollisionShape(), part.getWorldTransform());
}

enum Group { kMovable = 1, kImmovable = 2 };

btDefaultCollisionConstructionInfo pools(int max_pairs) {
    btDefaultCollisionConstructionInfo info;
    info.m_customCollisionAlgorithmMaxElementSize = 256;
    info.m_defaultMaxPersistentManifoldPoolSize = max_pairs;
    info.m_defaultMaxCollisionAlgorithmPoolSize = max_pairs;
    return info;
}

}  // namespace

double approach(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b, double h) {
    const btVector3 closing = a.getCollisionObject()->getInterpolationLinearVelocity() -
                              b.getCollisionObject()->getInterpolationLinearVelocity();
    return h * (closing.length() + turning(a) + turning(b));
}

Collision::Collision(int max_parts, int max_pairs)
    : configuration_(pools(max_pairs)),
      dispatcher_(&configuration_, max_pairs),
      polyhedra_(dispatcher_, step_),
      broadphase_(btVector3(-kWorldHalfExtent, -kWorldHalfExtent, -kWorldHalfExtent),
                  btVector3(kWorldHalfExtent, kWorldHalfExtent, kWorldHalfExtent),
                  static_cast<unsigned>(max_parts + 2), &pairs_, true),
      max_pairs_(max_pairs) {
    // the distance at which contacts are found is ours, whatever the shapes' size
    dispatcher_.setDispatcherFlags(
        dispatcher_.getDispatcherFlags() &
        ~btCollisionDispatcher::CD_USE_RELATIVE_CONTACT_BREAKING_THRESHOLD);
    manifolds_.reserve(static_cast<size_t>(max_pairs));
    looked_at_.reserve(static_cast<size_t>(max_pairs));
    live_.reserve(static_cast<size_t>(max_pairs));
    sorting_.reserve(static_cast<size_t>(max_pairs));
    scratch_.reserve(8);
    parts_.reserve(static_cast<size_t>(max_parts));
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
    // The cache's tables grow only with its pairs, and never shrink: so fill and empty it once.
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
    btVector3 low;
    btVector3 high;
    const btTransform X_WS = part.X_WS();
    part.shape->getAabb(X_WS, low, high);
    const btVector3 travel = h * part.body->getInterpolationLinearVelocity();
    const double most = kApproach + h * turning(*part.body, *part.shape, X_WS);
    const btVector3 margin = travel.absolute() + btVector3(most, most, most);
    broadphase_.setAabb(part.bounds, low - margin, high + margin, &dispatcher_);
}

void Collision::find_contacts(double h) {
    step_ = h;
    btDispatcherInfo info;
    info.m_timeStep = h;
    manifolds_.clear();

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
    if (several_parts_) sort_by_bodies();
}

void Collision::sort_by_bodies() {
    sorting_.clear();
    for (btPersistentManifold* manifold : manifolds_) {
        sorting_.push_back(
            {{manifold->getBody0()->getUserIndex(), manifold->getBody1()->getUserIndex(),
              static_cast<int>(sorting_.size())},
             manifold});
    }
    std::sort(sorting_.begin(), sorting_.end(),
              [](const OfBodies& a, const OfBodies& b) { return a.key < b.key; });
    for (size_t i = 0; i < sorting_.size(); ++i) manifolds_[i] = sorting_[i].manifold;
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
    const CollisionPart& part_a = part(pair.m_pProxy0);
    const CollisionPart& part_b = part(pair.m_pProxy1);
    btCollisionObject& a = *part_a.body;
    btCollisionObject& b = *part_b.body;
    const btTransform X_WA = part_a.X_WS();
    const btTransform X_WB = part_b.X_WS();
    const btCollisionObjectWrapper a_wrap(nullptr, part_a.shape.get(), &a, X_WA, -1, -1);
    const btCollisionObjectWrapper b_wrap(nullptr, part_b.shape.get(), &b, X_WB, -1, -1);
    // round shapes are met ahead of touch: Bullet asks for the distance in three places
    const double margin =
        std::min(kMostRoundMargin, kRoundMargin + approach(a_wrap, b_wrap, step_));
    gContactBreakingThreshold = margin;  // of manifolds to come
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
    pair.m_algorithm->getAllContactManifolds(scratch_);
    bool woke = false;
    for (int m = 0; m < scratch_.size(); ++m) {
        if (scratch_[m]->getNumContacts() == 0) continue;
        manifolds_.push_back(scratch_[m]);
        if (a.isStaticObject() || b.isStaticObject()) continue;
        for (btCollisionObject* object : {&a, &b}) {
            if (object->getUserIndex2() == kAwake) continue;
            object->setUserIndex2(kAwake);
            woke = true;
        }
    }
    return woke;
}

}  // namespace dihaptic::dynamics
