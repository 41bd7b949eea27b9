// Contacts of points, which no collision detection finds: whoever places a point says what it may
// meet in the coming step. They are kept as Bullet's manifolds, like all others, so that solvers
// start from the last step's impulses.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <vector>

#include "base/geometry.h"

namespace dihaptic::dynamics {

class PointContacts {
  public:
    /// Room for so many points, with kMostPointContacts each.
    void reserve(int points);

    struct Contact {
        const btCollisionObject* body = nullptr;
        const btCollisionObject* point = nullptr;
        int part = 0;  ///< of the body
        int face = 0;  ///< of the part: the same face goes on from its last impulse
        Vec3 n_W = Vec3::UnitZ();
        double gap = 0;
        double friction = 0;
        double torsion_radius = 0;
    };
    /// For the next take(); what is more than there is room for is left out.
    void add(const Contact& contact) noexcept;
    /// The manifolds of all that was added since the last call; others are forgotten.
    void take(std::vector<btPersistentManifold*>& out) noexcept;
    /// All of them, and the impulses that they had.
    void forget() noexcept;
    /// After bodies have moved by h [s]: what a turning body carries goes along an arc, a point's
    /// own step along its tangent. Of the bodies that press on it, by how hard they do, the
    /// difference [m].
    btVector3 bend(const btRigidBody& point, double h) const noexcept;

  private:
    struct Slot {
        std::unique_ptr<btPersistentManifold> manifold;
        int part = 0;
        int face = 0;
        bool fresh = false;
    };
    std::vector<Slot> slots_;
    std::vector<const btPersistentManifold*> taken_;
};

}  // namespace dihaptic::dynamics
