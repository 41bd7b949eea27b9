#include "dynamics/bullet/collision.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>

namespace dihaptic::dynamics {
namespace {

/// Bodies may leave this cube, but the broadphase then finds more pairs than necessary.
constexpr double kWorldHalfExtent = 10.0;  // [m]
/// Pairs of bodies are found at this distance before they touch.
constexpr double kApproach = 3e-3;        // [m]
constexpr double kMostHullMargin = 5e-2;  // limit of the margin for fast bodies [m]

enum Group { kMovable = 1, kImmovable = 2 };

btDefaultCollisionConstructionInfo pools(int max_pairs) {
    btDefaultCollisionConstructionInfo info;
    info.m_customCollisionAlgorithmMaxElementSize = 256;
    info.m_defaultMaxPersistentManifoldPoolSize = max_pairs;
    info.m_defaultMaxCollisionAlgorithmPoolSize = max_pairs + 1;  // 1 extra for find_entered()
    return info;
}

}  // namespace

Collision::Collision(int max_parts, int max_pairs)
    : configuration_(pools(max_pairs)),
      dispatcher_(&configuration_, max_pairs),
      algorithms_(dispatcher_, step_),
      broadphase_(btVector3(-kWorldHalfExtent, -kWorldHalfExtent, -kWorldHalfExtent),
                  btVector3(kWorldHalfExtent, kWorldHalfExtent, kWorldHalfExtent),
                  static_cast<unsigned>(max_parts + 2), &pairs_, true),
      max_pairs_(max_pairs),
      paths_(dispatcher_) {
    // find contacts at the distance set here, whatever the size of the shapes
    dispatcher_.setDispatcherFlags(
        dispatcher_.getDispatcherFlags() &
        ~btCollisionDispatcher::CD_USE_RELATIVE_CONTACT_BREAKING_THRESHOLD);
    manifolds_.reserve(static_cast<size_t>(max_pairs) + PathSearch::kMost);
    found_.reserve(static_cast<size_t>(max_pairs) + PathSearch::kMost);
    looked_at_.reserve(static_cast<size_t>(max_pairs));
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

const std::vector<int>& Collision::Pairs::live() {
    if (!is_stale_ && listed_version_ == version_) return live_;
    const auto awake = [](const btBroadphaseProxy* bounds) {
        return part_of(bounds).body->getUserIndex2() == kAwake;
    };
    live_.clear();
    for (int i = 0; i < getNumOverlappingPairs(); ++i) {
        const btBroadphasePair& pair = getOverlappingPairArray()[i];
        if (awake(pair.m_pProxy0) || awake(pair.m_pProxy1)) live_.push_back(i);
    }
    listed_version_ = version_;
    is_stale_ = false;
    return live_;
}

void Collision::reserve_pairs(int pairs) {
    pairs_.reserve_live(static_cast<size_t>(pairs));
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
    const double most = kApproach + h * part.turning_at(X_WS);
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
    paths_.restart();
    step_ = h;
    ++placing_;
    ++timing_;
    btDispatcherInfo info;
    info.m_timeStep = h;
    manifolds_.clear();
    found_.clear();

    btBroadphasePairArray& pairs = pairs_.getOverlappingPairArray();
    const auto count = static_cast<size_t>(pairs.size());
    overflowed_ = count > static_cast<size_t>(max_pairs_);
    looked_at_.assign(count, false);
    bool woke = true;
    while (woke) {
        woke = false;
        for (const int i : pairs_.live()) {
            if (looked_at_[static_cast<size_t>(i)]) continue;
            looked_at_[static_cast<size_t>(i)] = true;
            if (look_at(pairs[i], info)) woke = true;
        }
        if (woke) pairs_.sleepers_changed();
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
    const bool is_own = part_of(pair.m_pProxy0).is_own() && part_of(pair.m_pProxy1).is_own();
    return is_own ? static_cast<OwnAlgorithm*>(pair.m_algorithm) : nullptr;
}

bool Collision::look_at(btBroadphasePair& pair, const btDispatcherInfo& info) {
    CollisionPart& part_a = part_of(pair.m_pProxy0);
    CollisionPart& part_b = part_of(pair.m_pProxy1);
    for (CollisionPart* each : {&part_a, &part_b}) {
        each->place(placing_);
        each->time(timing_);
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
    paths_.begin(++timing_);
    for (const int i : pairs_.live()) {
        if (!paths_.may_go_on()) break;
        btPersistentManifold* const found =
            paths_.enters(pairs_.getOverlappingPairArray()[i], h, recovery, work);
        if (found == nullptr) continue;
        manifolds_.push_back(found);
        for (const btCollisionObject* object : {found->getBody0(), found->getBody1()}) {
            auto& body = const_cast<btCollisionObject&>(*object);
            if (body.isStaticObject() || body.getUserIndex2() == kAwake) continue;
            body.setUserIndex2(kAwake);
            pairs_.sleepers_changed();
        }
    }
    if (paths_.found().empty()) return false;
    sort_by_bodies();
    return true;
}

bool Collision::hold_back(double h, contact::Work& work) {
    paths_.begin(++timing_);
    bool found = false;
    for (const int i : pairs_.live()) {
        if (paths_.hold_back(pairs_.getOverlappingPairArray()[i], h, work)) found = true;
        if (paths_.was_cut()) break;
    }
    return found;
}

}  // namespace dihaptic::dynamics
