// Bullet's collision detection, stepped so that sleeping bodies cost nothing and nothing is
// allocated: a sweep-and-prune broadphase of fixed size, and narrow-phase contact manifolds from
// pools.
#pragma once

#include <btBulletCollisionCommon.h>

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "dynamics/bullet/polyhedron_algorithm.h"

namespace dihaptic::dynamics {

class Collision {
  public:
    /// Room for so many bodies and so many touching pairs.
    Collision(int max_bodies, int max_pairs);
    ~Collision();

    /// The object must outlive this. Its user index names the body; its user index 2 is 1 when
    /// awake.
    void add(btCollisionObject& object, bool can_move);
    void update_bounds(btCollisionObject& object, double h);

    /// Finds the contacts of all pairs with an awake body. Sleeping bodies that an awake one
    /// touches wake: their user index 2 becomes 1, and their pairs are looked at too.
    void find_contacts(double h);
    /// Tells that bodies fell asleep or woke: other pairs are to be looked at.
    void sleepers_changed() { live_is_stale_ = true; }

    /// The manifolds with contacts of the last find_contacts().
    std::vector<btPersistentManifold*>& manifolds() { return manifolds_; }
    btDispatcher& dispatcher() { return dispatcher_; }
    bool overflowed() const { return overflowed_; }

  private:
    /// Tells when pairs come and go.
    class Pairs final : public btHashedOverlappingPairCache {
      public:
        btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
            ++version;
            return btHashedOverlappingPairCache::addOverlappingPair(a, b);
        }
        void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                    btDispatcher* dispatcher) override {
            ++version;
            return btHashedOverlappingPairCache::removeOverlappingPair(a, b, dispatcher);
        }
        int64_t version = 0;
    };

    void reserve_pairs(int pairs);
    void list_live_pairs();
    bool look_at(btBroadphasePair& pair, const btDispatcherInfo& info);

    btDefaultCollisionConfiguration configuration_;
    struct ReservedDispatcher : btCollisionDispatcher {
        ReservedDispatcher(btCollisionConfiguration* configuration, int manifolds)
            : btCollisionDispatcher(configuration) {
            m_manifoldsPtr.reserve(manifolds);
        }
    } dispatcher_;
    double step_ = 1e-3;
    PolyhedronAlgorithms polyhedra_;
    Pairs pairs_;
    bt32BitAxisSweep3 broadphase_;
    int max_pairs_;
    std::vector<btCollisionObject*> objects_;
    std::vector<btPersistentManifold*> manifolds_;
    btManifoldArray scratch_;
    std::vector<int> live_;      // pairs with an awake body, by index into the cache
    int64_t live_version_ = -1;  // of the pairs that live_ was made from
    bool live_is_stale_ = true;
    std::vector<char> looked_at_;  // by pair
    bool overflowed_ = false;
};

constexpr int kAwake = 1;

/// How far the surfaces of two bodies may come closer in a step, by their velocities before
/// contacts act: nothing that could touch in the step is further apart [m].
double approach(const btCollisionObject& a, const btCollisionObject& b, double h);

}  // namespace dihaptic::dynamics
