// Collision runs Bullet's collision detection in such a way that sleeping bodies cost nothing and
// no memory is allocated: it uses a sweep-and-prune broadphase of fixed size, and takes the contact
// manifolds of the narrow phase from pools.
#pragma once

#include <btBulletCollisionCommon.h>

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dynamics/bullet/contact_algorithm.h"
#include "dynamics/bullet/path_search.h"
#include "dynamics/bullet/seams.h"
#include "dynamics/bullet/shape.h"

namespace dihaptic::dynamics {

class Collision {
  public:
    /// Reserves memory for the given numbers of body parts and of pairs of parts that touch.
    Collision(int max_parts, int max_pairs);
    ~Collision();

    /// Adds a part. The part and its body must outlive this object. The body is identified by its
    /// user index; its user index 2 is 1 while the body is awake.
    void add(CollisionPart& part, bool can_move);
    /// To be called for each part of a body that has moved or is about to move.
    void update_bounds(CollisionPart& part, double h);
    /// Like update_bounds(), but the bounds can only grow: a pair whose contacts are in manifolds()
    /// must not be dropped within a step.
    void widen_bounds(CollisionPart& part, double h);
    /// Hides a part: from the next find_contacts() on, it has no contacts until show() is called
    /// and its bounds are updated.
    void hide(CollisionPart& part);
    void show(CollisionPart& part) { part.hidden = false; }

    /// Forgets all contacts and their impulses.
    void forget();

    /// Finds the contacts of all pairs that include an awake body. A sleeping body touched by an
    /// awake one wakes up: its user index 2 becomes 1, and its pairs are searched too.
    void find_contacts(double h);
    /// Searches along the paths of all bodies (path_search.h) and adds contacts to manifolds() for
    /// bodies that would enter each other. Returns false if no contact was added. Wakes bodies like
    /// find_contacts(). Strides along the paths are counted in `work`; when it is used up, the
    /// search ends.
    bool find_entered(double h, double recovery, contact::Work& work);
    /// The last resort if find_entered() does not suffice: bodies that would still enter each other
    /// cover only a fraction of their path in the step, their hit fraction, which is 1 before the
    /// first call. Returns false if there are no such bodies.
    bool hold_back(double h, contact::Work& work);
    const PathSearch& paths() const { return paths_; }

    /// To be called when bodies have fallen asleep or woken up, so that other pairs must be
    /// searched.
    void sleepers_changed() { pairs_.sleepers_changed(); }

    /// The manifolds that have contacts from the last find_contacts(). Manifolds between the same
    /// two bodies are adjacent.
    std::vector<btPersistentManifold*>& manifolds() { return manifolds_; }
    /// Calls `use` with every manifold, including those of sleeping bodies.
    template <class Use>
    void for_each_manifold(const Use& use) const {
        for (int i = 0; i < dispatcher_.getNumManifolds(); ++i)
            use(*dispatcher_.getManifoldByIndexInternal(i));
        for (const auto& manifold : paths_.manifolds()) use(*manifold);
    }
    int max_pairs() const { return max_pairs_; }
    bool overflowed() const { return overflowed_; }

  private:
    /// A pair cache that lists the pairs with an awake body. The list is made again only when pairs
    /// have appeared or disappeared, or bodies have fallen asleep or woken up.
    class Pairs final : public btHashedOverlappingPairCache {
      public:
        btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
            ++version_;
            return btHashedOverlappingPairCache::addOverlappingPair(a, b);
        }
        void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                    btDispatcher* dispatcher) override {
            ++version_;
            return btHashedOverlappingPairCache::removeOverlappingPair(a, b, dispatcher);
        }
        void reserve_live(size_t pairs) { live_.reserve(pairs); }
        void sleepers_changed() { is_stale_ = true; }
        /// Returns the indices of the pairs with an awake body.
        const std::vector<int>& live();

      private:
        std::vector<int> live_;
        int64_t version_ = 0;
        int64_t listed_version_ = -1;  // version for which live_ was made
        bool is_stale_ = true;
    };

    /// Excludes pairs of parts that belong to the same body, pairs of bodies between which a joint
    /// excludes contact, and pairs with a hidden part.
    struct OtherBodies final : btOverlapFilterCallback {
        bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
            return (a->m_collisionFilterGroup & b->m_collisionFilterMask) != 0 &&
                   (b->m_collisionFilterGroup & a->m_collisionFilterMask) != 0 &&
                   part_of(a).body != part_of(b).body && !part_of(a).hidden && !part_of(b).hidden &&
                   part_of(a).body->checkCollideWith(part_of(b).body);
        }
    };

    void set_bounds(CollisionPart& part, double h, bool keep);
    /// Returns the pair's algorithm if it is one of our own, otherwise null.
    static OwnAlgorithm* own(const btBroadphasePair& pair);
    /// Whether the contacts of two parts may be carried along: each of them is part of a heap or
    /// fixed.
    static bool may_be_carried(const CollisionPart& a, const CollisionPart& b);
    void reserve_pairs(int pairs);
    void sort_by_bodies();
    /// Removes contacts at points inside bodies that consist of several parts (seams.h).
    void remove_inner();
    /// Finds the contacts of a pair. Returns whether a body woke up.
    bool look_at(btBroadphasePair& pair, const btDispatcherInfo& info);
    /// Computes the contacts of a pair. Returns false if there is no algorithm for its parts.
    bool examine(btBroadphasePair& pair, const CollisionPart& part_a, const CollisionPart& part_b,
                 const btDispatcherInfo& info);
    /// Lists the manifolds in scratch_. Returns whether a body woke up.
    bool list_found(const CollisionPart& part_a, const CollisionPart& part_b);

    btDefaultCollisionConfiguration configuration_;
    /// Provides memory for its manifolds, and gives each new manifold this world's own breaking
    /// threshold, since Bullet's threshold is global to the program.
    struct Dispatcher : btCollisionDispatcher {
        Dispatcher(btCollisionConfiguration* configuration, int manifolds)
            : btCollisionDispatcher(configuration) {
            m_manifoldsPtr.reserve(manifolds);
        }
        btPersistentManifold* getNewManifold(const btCollisionObject* a,
                                             const btCollisionObject* b) override {
            btPersistentManifold* const manifold = btCollisionDispatcher::getNewManifold(a, b);
            if (manifold != nullptr) manifold->setContactBreakingThreshold(margin);
            return manifold;
        }
        btScalar margin = 0;  ///< for the pair that is being examined [m]
    } dispatcher_;
    double step_ = 1e-3;
    ContactAlgorithms algorithms_;
    Pairs pairs_;
    bt32BitAxisSweep3 broadphase_;
    int max_pairs_;
    OtherBodies other_bodies_;
    std::vector<CollisionPart*> parts_;
    int64_t placing_ = 0;         // number of the current search; bodies do not move within it
    int64_t timing_ = 0;          // the same, but the velocities do not change within it
    bool several_parts_ = false;  // whether any body has several parts
    struct OfBodies {
        std::array<int, 3> key;  // indices of both bodies, and the order of detection
        OfParts of;
    };
    std::vector<OfBodies> sorting_;
    std::vector<OfParts> found_;  // in the same order as manifolds_
    std::vector<btPersistentManifold*> manifolds_;
    btManifoldArray scratch_;
    std::vector<char> looked_at_;  // for each pair, whether it was examined
    bool overflowed_ = false;
    PathSearch paths_;
};

constexpr int kAwake = 1;
/// User index 3 of bodies that were part of a heap in the last step (World::Impl::is_heap): their
/// contacts with each other may be carried along.
constexpr int kInHeap = 1;

}  // namespace dihaptic::dynamics
