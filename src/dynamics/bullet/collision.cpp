#include "dynamics/bullet/collision.h"

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

/// Largest speed of a point of the body by its turning; its centre lies anywhere inside [m/s].
double turning(const btCollisionObject& object) {
    const btScalar speed = object.getInterpolationAngularVelocity().length();
    if (speed == 0) return 0;
    btVector3 centre;
    btScalar radius = 0;
    object.getCollisionShape()->getBoundingSphere(centre, radius);
    return speed * (centre.length() + radius);
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

double approach(const btCollisionObject& a, const btCollisionObject& b, double h) {
    const btVector3 closing =
        a.getInterpolationLinearVelocity() - b.getInterpolationLinearVelocity();
    return h * (closing.length() + turning(a) + turning(b));
}

Collision::Collision(int max_bodies, int max_pairs)
    : configuration_(pools(max_pairs)),
      dispatcher_(&configuration_, max_pairs),
      polyhedra_(dispatcher_, step_),
      broadphase_(btVector3(-kWorldHalfExtent, -kWorldHalfExtent, -kWorldHalfExtent),
                  btVector3(kWorldHalfExtent, kWorldHalfExtent, kWorldHalfExtent),
                  static_cast<unsigned>(max_bodies + 2), &pairs_, true),
      max_pairs_(max_pairs) {
    // the distance at which contacts are found is ours, whatever the shapes' size
    dispatcher_.setDispatcherFlags(
        dispatcher_.getDispatcherFlags() &
        ~btCollisionDispatcher::CD_USE_RELATIVE_CONTACT_BREAKING_THRESHOLD);
    manifolds_.reserve(static_cast<size_t>(max_pairs));
    looked_at_.reserve(static_cast<size_t>(max_pairs));
    live_.reserve(static_cast<size_t>(max_pairs));
    scratch_.reserve(8);
    objects_.reserve(static_cast<size_t>(max_bodies));
    reserve_pairs(max_pairs);
}

Collision::~Collision() {
    for (btCollisionObject* object : objects_) {
        pairs_.cleanProxyFromPairs(object->getBroadphaseHandle(), &dispatcher_);
        broadphase_.destroyProxy(object->getBroadphaseHandle(), &dispatcher_);
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

void Collision::add(btCollisionObject& object, bool can_move) {
    btVector3 low;
    btVector3 high;
    object.getCollisionShape()->getAabb(object.getWorldTransform(), low, high);
    object.setBroadphaseHandle(
        broadphase_.createProxy(low, high, object.getCollisionShape()->getShapeType(), &object,
                                can_move ? kMovable : kImmovable,
                                can_move ? kMovable | kImmovable : kMovable, &dispatcher_));
    objects_.push_back(&object);
}

void Collision::update_bounds(btCollisionObject& object, double h) {
    btVector3 low;
    btVector3 high;
    object.getCollisionShape()->getAabb(object.getWorldTransform(), low, high);
    const btVector3 travel = h * object.getInterpolationLinearVelocity();
    const double most = kApproach + h * turning(object);
    const btVector3 margin = travel.absolute() + btVector3(most, most, most);
    broadphase_.setAabb(object.getBroadphaseHandle(), low - margin, high + margin, &dispatcher_);
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
}

void Collision::list_live_pairs() {
    const auto awake = [](const btBroadphaseProxy* proxy) {
        return static_cast<const btCollisionObject*>(proxy->m_clientObject)->getUserIndex2() ==
               kAwake;
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
    auto& object0 = *static_cast<btCollisionObject*>(pair.m_pProxy0->m_clientObject);
    auto& object1 = *static_cast<btCollisionObject*>(pair.m_pProxy1->m_clientObject);
    if (!dispatcher_.needsCollision(&object0, &object1)) return false;
    const btCollisionObjectWrapper wrap0(nullptr, object0.getCollisionShape(), &object0,
                                         object0.getWorldTransform(), -1, -1);
    const btCollisionObjectWrapper wrap1(nullptr, object1.getCollisionShape(), &object1,
                                         object1.getWorldTransform(), -1, -1);
    // round shapes are met ahead of touch: Bullet asks for the distance in three places
    const double margin =
        std::min(kMostRoundMargin, kRoundMargin + approach(object0, object1, step_));
    gContactBreakingThreshold = margin;  // of manifolds to come
    scratch_.resizeNoInitialize(0);
    if (pair.m_algorithm == nullptr) {
        pair.m_algorithm =
            dispatcher_.findAlgorithm(&wrap0, &wrap1, nullptr, BT_CONTACT_POINT_ALGORITHMS);
        if (pair.m_algorithm == nullptr) return false;
    } else {
        pair.m_algorithm->getAllContactManifolds(scratch_);
        for (int m = 0; m < scratch_.size(); ++m) scratch_[m]->setContactBreakingThreshold(margin);
        scratch_.resizeNoInitialize(0);
    }
    btManifoldResult result(&wrap0, &wrap1);
    result.m_closestPointDistanceThreshold = margin;
    pair.m_algorithm->processCollision(&wrap0, &wrap1, info, &result);
    pair.m_algorithm->getAllContactManifolds(scratch_);
    bool woke = false;
    for (int m = 0; m < scratch_.size(); ++m) {
        if (scratch_[m]->getNumContacts() == 0) continue;
        manifolds_.push_back(scratch_[m]);
        auto& a = *static_cast<btCollisionObject*>(pair.m_pProxy0->m_clientObject);
        auto& b = *static_cast<btCollisionObject*>(pair.m_pProxy1->m_clientObject);
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
