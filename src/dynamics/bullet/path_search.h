// PathSearch looks for bodies that would enter each other in the course of a step, although the
// contacts found at its start are satisfied. README.md derives the contacts that it adds.
#pragma once

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <memory>
#include <span>
#include <vector>

#include "contact/work.h"
#include "dynamics/bullet/shape.h"

struct btCollisionObjectWrapper;

namespace dihaptic::dynamics {

/// Bullet finds contacts between hulls with many edges at this distance before the hulls touch, and
/// at a larger distance if the bodies could approach each other by more in the step.
constexpr double kHullMargin = 2e-3;  // [m]
/// Depth to which a step may let a body enter another [m].
constexpr double kEntered = 1e-4;

class PathSearch {
  public:
    static constexpr size_t kMost = 64;  ///< most pairs that enter each other in a step

    explicit PathSearch(btCollisionDispatcher& dispatcher);

    /// Forgets the pairs of the last step.
    void restart();
    /// Starts another search in the same step; velocities do not change within a search. `number`
    /// identifies the search.
    void begin(int64_t number);

    /// Searches along the paths of a pair's bodies, moving at their current velocities, in a step
    /// of h. Returns the contacts through which they enter each other by more than kEntered, or
    /// null if they do not or if no further pair can be stored. The fraction `recovery` of a
    /// penetration is removed per step.
    btPersistentManifold* enters(btBroadphasePair& pair, double h, double recovery,
                                 contact::Work& work);
    /// If the bodies of a pair would enter each other further than they already have, reduces their
    /// hit fractions, i.e. the fraction of their path that they cover in the step, and returns
    /// true.
    bool hold_back(btBroadphasePair& pair, double h, contact::Work& work);

    /// Whether pairs may have been missed since restart(): there was no memory for them, or bodies
    /// already inside each other were assumed to be leaving.
    bool is_unsure() const { return is_unsure_ || count_ == kMost; }
    /// Whether strides have been skipped since restart(), because work ran out.
    bool was_cut() const { return was_cut_; }
    /// Whether another pair can be searched.
    bool may_go_on() const { return count_ < kMost && !was_cut_; }
    /// The contacts found since begin().
    std::span<btPersistentManifold* const> found() const { return found_; }
    /// The memory for contacts.
    std::span<const std::unique_ptr<btPersistentManifold>> manifolds() const { return manifolds_; }

  private:
    /// Whether the work budget suffices for another stride. If so, spends that work; if not, notes
    /// that the search was cut.
    bool affords(contact::Work& work, int64_t visits);
    /// Follows two parts along their paths in a step, from stride number `first` on, and as far as
    /// the hit fractions of their bodies allow. At each stride, writes their contacts to `out` and
    /// calls `visit` with the initial poses of both bodies and the time since then [s]. Returns the
    /// fraction of the path that was covered before `visit` first returned true.
    template <class Visit>
    double walk(btBroadphasePair& pair, double h, int first, btPersistentManifold& out,
                contact::Work& work, const Visit& visit);
    /// Returns the first manifold of a pair, or null if there is none.
    const btPersistentManifold* manifold_of(const btBroadphasePair& pair);
    /// Finds the contacts of two parts at their current poses. Returns false if there is no
    /// algorithm for these parts.
    bool meet(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
              btPersistentManifold& out);

    btCollisionDispatcher& dispatcher_;
    btManifoldArray scratch_;
    std::vector<std::unique_ptr<btPersistentManifold>> manifolds_;
    size_t count_ = 0;              // number of manifolds in use
    btPersistentManifold waiting_;  // contacts of two bodies, in hold_back()
    std::vector<btPersistentManifold*> found_;
    int64_t number_ = 0;
    bool was_cut_ = false;
    bool is_unsure_ = false;
};

}  // namespace dihaptic::dynamics
