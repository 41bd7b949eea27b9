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
/// A new contact continues an old one if the two are within this distance on the body.
constexpr double kSamePoint = 5e-3;  // [m]

const CollisionPart& part_of(const btCollisionObjectWrapper& part) {
    return *static_cast<const CollisionPart*>(part.getCollisionShape()->getUserPointer());
}

bool is_plane(const btCollisionObjectWrapper& part) {
    return part.getCollisionShape()->getShapeType() == STATIC_PLANE_PROXYTYPE;
}

class Algorithm final : public btActivatingCollisionAlgorithm {
  public:
    Algorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
              const btCollisionObjectWrapper* b, const double& step)
        : btActivatingCollisionAlgorithm(info, a, b), manifold_(info.m_manifold), step_(step) {
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
        const Pose X_WA = from_bullet(a_wrap->getWorldTransform());
        const Pose X_WB = from_bullet(b_wrap->getWorldTransform());
        const double margin = std::min(kMostMargin, kMargin + approach(*a_wrap, *b_wrap, step_));
        const Move move = {
            step_ * from_bullet(b_wrap->getCollisionObject()->getInterpolationLinearVelocity() -
                                a.getInterpolationLinearVelocity()),
            step_ * from_bullet(b_wrap->getCollisionObject()->getInterpolationAngularVelocity() -
                                a.getInterpolationAngularVelocity())};
        ContactPatch patch = meet(*a_wrap, X_WA, *b_wrap, X_WB, margin, move);
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

    /// Replaces the manifold's points. Bullet's normal points from its body 1 to its body 0.
    void store(ContactPatch& patch, const Pose& X_WA, const Pose& X_WB, bool a_is_body0) {
        std::array<btManifoldPoint, 4> old;
        std::array<bool, 4> taken{};
        const int old_count = manifold_->getNumContacts();
        for (int i = 0; i < old_count; ++i)
            old[static_cast<size_t>(i)] = manifold_->getContactPoint(i);
        manifold_->clearManifold();
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
                const double d =
                    (old[static_cast<size_t>(j)].m_localPointA - out.m_localPointA).length2();
                // a single point counts as the same one while a round body rolls
                const bool only = old_count == 1 && patch.count == 1;
                if (!taken[static_cast<size_t>(j)] && (d < distance || only)) {
                    distance = d;
                    nearest = j;
                }
            }
            if (nearest >= 0) {
                const btManifoldPoint& last = old[static_cast<size_t>(nearest)];
                taken[static_cast<size_t>(nearest)] = true;
                out.m_userPersistentData = last.m_userPersistentData;
                out.m_lifeTime = last.m_lifeTime + 1;
            }
            manifold_->addManifoldPoint(out);
        }
    }

    btPersistentManifold* manifold_;
    bool owned_ = false;
    const double& step_;
};

}  // namespace

struct ContactAlgorithms::Create final : btCollisionAlgorithmCreateFunc {
    Create(const double& h, btCollisionAlgorithmCreateFunc* bullets)
        : step(h), otherwise(bullets) {}

    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override {
        const auto known = [](const btCollisionObjectWrapper* w) {
            return is_plane(*w) || part_of(*w).polyhedron || part_of(*w).round;
        };
        if (!known(a) || !known(b)) return otherwise->CreateCollisionAlgorithm(info, a, b);
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
