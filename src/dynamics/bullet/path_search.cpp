#include "dynamics/bullet/path_search.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>

#include "dynamics/bullet/carried.h"

namespace dihaptic::dynamics {
namespace {

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

}  // namespace

PathSearch::PathSearch(btCollisionDispatcher& dispatcher) : dispatcher_(dispatcher) {
    scratch_.reserve(8);
    found_.reserve(kMost);
    for (size_t i = 0; i < kMost; ++i) {
        manifolds_.push_back(std::make_unique<btPersistentManifold>());
        // Bullet's constructor does not set this threshold
        manifolds_.back()->setContactBreakingThreshold(BT_LARGE_FLOAT);
    }
}

void PathSearch::restart() {
    was_cut_ = is_unsure_ = false;
    count_ = 0;
}

void PathSearch::begin(int64_t number) {
    number_ = number;
    found_.clear();
}

btPersistentManifold* PathSearch::enters(btBroadphasePair& pair, double h, double recovery,
                                         contact::Work& work) {
    if (!may_go_on()) return nullptr;
    btPersistentManifold& out = *manifolds_[count_];
    const double free = walk(
        pair, h, 1, out, work, [&](const btTransform& from_0, const btTransform& from_1, double t) {
            bool entered = false;
            const bool is_in = depth_of(out) < -kEntered;
            for (int i = 0; i < out.getNumContacts(); ++i)
                entered |= look_back(out, out.getContactPoint(i), from_0, from_1, t, h, recovery);
            is_unsure_ = is_unsure_ || (is_in && !entered);
            return entered;
        });
    if (!(free < 1)) return nullptr;
    ++count_;
    found_.push_back(&out);
    return &out;
}

bool PathSearch::hold_back(btBroadphasePair& pair, double h, contact::Work& work) {
    btPersistentManifold& out = waiting_;
    double at_first = 0;
    const double share =
        walk(pair, h, 0, out, work, [&](const btTransform&, const btTransform&, double t) {
            const double now = depth_of(out);
            if (t == 0) at_first = now;
            return now < at_first - kEntered;
        });
    const bool is_in = at_first < -kEntered;
    if (share == 1 || (is_in && share == 0)) return false;
    for (const btBroadphaseProxy* proxy : {pair.m_pProxy0, pair.m_pProxy1}) {
        btCollisionObject& body = *part_of(proxy).body;
        body.setHitFraction(share * body.getHitFraction());
    }
    return true;
}

bool PathSearch::affords(contact::Work& work, int64_t visits) {
    was_cut_ = !work.affords(visits);
    if (!was_cut_) work.spend(visits);
    return !was_cut_;
}

const btPersistentManifold* PathSearch::manifold_of(const btBroadphasePair& pair) {
    scratch_.resizeNoInitialize(0);
    if (pair.m_algorithm != nullptr) pair.m_algorithm->getAllContactManifolds(scratch_);
    return scratch_.size() > 0 ? scratch_[0] : nullptr;
}

bool PathSearch::meet(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
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
double PathSearch::walk(btBroadphasePair& pair, double h, int first, btPersistentManifold& out,
                        contact::Work& work, const Visit& visit) {
    CollisionPart& part_a = part_of(pair.m_pProxy0);
    CollisionPart& part_b = part_of(pair.m_pProxy1);
    part_a.time(number_);
    part_b.time(number_);
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

}  // namespace dihaptic::dynamics
