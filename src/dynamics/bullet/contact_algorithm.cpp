#include "dynamics/bullet/contact_algorithm.h"

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include <algorithm>

#include "dynamics/bullet/carried.h"
#include "dynamics/bullet/collision.h"
#include "dynamics/bullet/shape.h"
#include "dynamics/patch.h"

namespace dihaptic::dynamics {
namespace {

/// Contacts are found at this distance before bodies touch, and at a larger distance if the bodies
/// could approach each other by more in the step.
constexpr double kMargin = 5e-4;      // [m]
constexpr double kMostMargin = 0.25;  // [m]
/// Contacts are carried along while the sum of the ways of both parts is at most this [m].
constexpr double kMostCarried = 5e-5;
/// A new contact continues an old one if the two are within this distance on the body.
constexpr double kSamePoint = 5e-3;  // [m]

const CollisionPart& part_of(const btCollisionObjectWrapper& part) {
    return *static_cast<const CollisionPart*>(part.getCollisionShape()->getUserPointer());
}

Pose pose_of(const btCollisionObjectWrapper& wrap) {
    const CollisionPart& part = part_of(wrap);
    const btTransform& X_WS = wrap.getWorldTransform();
    return &X_WS == &part.placed_at ? part.X_WS_placed : from_bullet(X_WS);
}

bool is_plane(const btCollisionObjectWrapper& part) {
    return part.getCollisionShape()->getShapeType() == STATIC_PLANE_PROXYTYPE;
}

class Algorithm final : public OwnAlgorithm {
  public:
    Algorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
              const btCollisionObjectWrapper* b, const double& step)
        : OwnAlgorithm(info, a, b, step) {
        if (manifold_ == nullptr) {
            manifold_ =
                m_dispatcher->getNewManifold(a->getCollisionObject(), b->getCollisionObject());
            owned_ = true;
        }
    }
    ~Algorithm() override {
        if (owned_) m_dispatcher->releaseManifold(manifold_);
    }

    void processCollision(const btCollisionObjectWrapper* a_wrap,
                          const btCollisionObjectWrapper* b_wrap, const btDispatcherInfo&,
                          btManifoldResult* result) override {
        const btCollisionObject& a = *a_wrap->getCollisionObject();
        const Pose X_WA = pose_of(*a_wrap);
        const Pose X_WB = pose_of(*b_wrap);
        const CollisionPart& part_a = part_of(*a_wrap);
        const CollisionPart& part_b = part_of(*b_wrap);
        const double margin = std::min(kMostMargin, kMargin + approach(part_a, part_b, step_));
        const Move move = {
            step_ * from_bullet(b_wrap->getCollisionObject()->getInterpolationLinearVelocity() -
                                a.getInterpolationLinearVelocity()),
            step_ * from_bullet(b_wrap->getCollisionObject()->getInterpolationAngularVelocity() -
                                a.getInterpolationAngularVelocity())};
        ContactPatch patch = meet(*a_wrap, X_WA, *b_wrap, X_WB, margin, move);
        examined_at_ = part_a.way + part_b.way;
        apart_until_ = examined_at_ + patch.apart;
        result->setPersistentManifold(manifold_);
        store(patch, X_WA, X_WB, manifold_->getBody0() == &a);
    }

    btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                   btManifoldResult*) override {
        return 1;
    }
    void getAllContactManifolds(btManifoldArray& manifolds) override {
        manifolds.push_back(manifold_);
    }

  private:
    static ContactPatch flipped(ContactPatch patch) {
        flip(patch);
        return patch;
    }

    /// Displacement of b relative to a during the step.
    struct Move {
        Vec3 way_W;
        Vec3 turn_W;
        Move operator-() const { return {-way_W, -turn_W}; }
    };

    static ContactPatch meet(const btCollisionObjectWrapper& a_wrap, const Pose& X_WA,
                             const btCollisionObjectWrapper& b_wrap, const Pose& X_WB,
                             double margin, const Move& move) {
        const CollisionPart& a = part_of(a_wrap);
        const CollisionPart& b = part_of(b_wrap);
        if (is_plane(b_wrap)) return flipped(meet(b_wrap, X_WB, a_wrap, X_WA, margin, -move));
        if (is_plane(a_wrap)) {
            return b.polyhedron ? collide_half_space(X_WA, *b.polyhedron, X_WB, margin)
                                : collide_half_space(X_WA, *b.round, X_WB, margin, move.turn_W);
        }
        if (a.round && b.round) return collide(*a.round, X_WA, *b.round, X_WB, margin);
        if (a.round) return flipped(meet(b_wrap, X_WB, a_wrap, X_WA, margin, -move));
        return b.round
                   ? collide(*a.polyhedron, X_WA, *b.round, X_WB, margin, move.way_W, move.turn_W)
                   : collide(*a.polyhedron, X_WA, *b.polyhedron, X_WB, margin, move.way_W);
    }

    /// What a new point takes over from an old one.
    struct Old {
        btVector3 local_a;
        void* data = nullptr;
        int life_time = 0;
        bool taken = false;
    };

    /// Replaces the manifold's points. Bullet's normal points from its body 1 to its body 0.
    void store(ContactPatch& patch, const Pose& X_WA, const Pose& X_WB, bool a_is_body0) {
        std::array<Old, 4> old;
        const int old_count = manifold_->getNumContacts();
        for (int i = 0; i < old_count; ++i) {
            const btManifoldPoint& point = manifold_->getContactPoint(i);
            old[static_cast<size_t>(i)] = {point.m_localPointA, point.m_userPersistentData,
                                           point.m_lifeTime};
        }
        manifold_->clearManifold();
        if (patch.count == 0) return;
        if (!a_is_body0) flip(patch);
        const Pose& X_W0 = a_is_body0 ? X_WA : X_WB;
        const Pose& X_W1 = a_is_body0 ? X_WB : X_WA;
        const Pose X_0W = X_W0.inverse();
        const Pose X_1W = X_W1.inverse();
        for (int i = 0; i < patch.count; ++i) {
            const ContactPoint& point = patch.points[static_cast<size_t>(i)];
            btManifoldPoint out(to_bullet(X_0W * point.p_WA), to_bullet(X_1W * point.p_WB),
                                to_bullet(Vec3(-patch.n_W)), point.gap);
            out.m_positionWorldOnA = to_bullet(point.p_WA);
            out.m_positionWorldOnB = to_bullet(point.p_WB);
            roll_ahead(out, point.ahead_W);
            int nearest = -1;
            double distance = kSamePoint * kSamePoint;
            for (int j = 0; j < old_count; ++j) {
                const Old& one = old[static_cast<size_t>(j)];
                const double d = (one.local_a - out.m_localPointA).length2();
                // a single point counts as the same one while a round body rolls
                const bool only = old_count == 1 && patch.count == 1;
                if (!one.taken && (d < distance || only)) {
                    distance = d;
                    nearest = j;
                }
            }
            if (nearest >= 0) {
                Old& last = old[static_cast<size_t>(nearest)];
                last.taken = true;
                out.m_userPersistentData = last.data;
                out.m_lifeTime = last.life_time + 1;
            }
            manifold_->addManifoldPoint(out);
        }
    }

    bool owned_ = false;
};

}  // namespace

bool OwnAlgorithm::stay_apart(const CollisionPart& a, const CollisionPart& b) const noexcept {
    const double left = apart_until_ - a.way - b.way;
    return left > 0 && left > std::min(kMostMargin, kMargin + approach(a, b, step_));
}

bool OwnAlgorithm::carry(const CollisionPart& a, const CollisionPart& b) noexcept {
    const auto may = [](const CollisionPart& part) { return !part.round || part.is_ball(); };
    if (manifold_->getNumContacts() == 0 || !may(a) || !may(b)) return false;
    if (a.way + b.way - examined_at_ > kMostCarried) return false;
    const bool in_order = manifold_->getBody0() == a.body;
    const CollisionPart& zero = in_order ? a : b;
    const CollisionPart& one = in_order ? b : a;
    for (int i = 0; i < manifold_->getNumContacts(); ++i) {
        btManifoldPoint& point = manifold_->getContactPoint(i);
        const Vec3 n_W = from_bullet(point.m_normalWorldOnB);  // towards body 0
        // the point of a ball stays on the side of the other body while the ball rolls
        const auto on = [&](const CollisionPart& part, const btVector3& p, double sign) {
            const Pose& X_WS = part.X_WS_placed;
            return part.is_ball() ? Vec3(X_WS.p + sign * part.round->radius * n_W)
                                  : X_WS * from_bullet(p);
        };
        Vec3 on_zero = on(zero, point.m_localPointA, -1);
        Vec3 on_one = on(one, point.m_localPointB, 1);
        const double gap = n_W.dot(on_zero - on_one);
        if (zero.is_ball()) {
            on_one = on_zero - gap * n_W;
        } else if (one.is_ball()) {
            on_zero = on_one + gap * n_W;
        }
        point.m_positionWorldOnA = to_bullet(on_zero);
        point.m_positionWorldOnB = to_bullet(on_one);
        point.m_distance1 = gap;
        ++point.m_lifeTime;
    }
    return true;
}

struct ContactAlgorithms::Create final : btCollisionAlgorithmCreateFunc {
    Create(const double& h, btCollisionAlgorithmCreateFunc* bullets)
        : step(h), otherwise(bullets) {}

    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override {
        if (!part_of(*a).is_own() || !part_of(*b).is_own())
            return otherwise->CreateCollisionAlgorithm(info, a, b);
        void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Algorithm));
        return new (memory) Algorithm(info, a, b, step);
    }

    const double& step;
    btCollisionAlgorithmCreateFunc* otherwise;
};

ContactAlgorithms::ContactAlgorithms(btCollisionDispatcher& dispatcher, const double& step) {
    constexpr std::array kTypes{BOX_SHAPE_PROXYTYPE,     CONVEX_HULL_SHAPE_PROXYTYPE,
                                STATIC_PLANE_PROXYTYPE,  SPHERE_SHAPE_PROXYTYPE,
                                CAPSULE_SHAPE_PROXYTYPE, CYLINDER_SHAPE_PROXYTYPE,
                                CONE_SHAPE_PROXYTYPE};
    for (const int a : kTypes) {
        for (const int b : kTypes) {
            if (a == STATIC_PLANE_PROXYTYPE && b == STATIC_PLANE_PROXYTYPE) continue;
            btCollisionAlgorithmCreateFunc* otherwise =
                dispatcher.getCollisionConfiguration()->getCollisionAlgorithmCreateFunc(a, b);
            creators_.push_back(std::make_unique<Create>(step, otherwise));
            dispatcher.registerCollisionCreateFunc(a, b, creators_.back().get());
        }
    }
}

ContactAlgorithms::~ContactAlgorithms() = default;

}  // namespace dihaptic::dynamics
