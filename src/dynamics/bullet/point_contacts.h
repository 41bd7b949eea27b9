// PointContacts stores the contacts of points. Collision detection does not find these; instead,
// the owner of a point lists its possible contacts in the coming step. They are stored as Bullet
// manifolds, like all other contacts, so that solvers start from the last step's impulses.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <vector>

#include "base/geometry.h"

namespace dihaptic::dynamics {

class PointContacts {
  public:
    /// Reserves memory for this many points, with kMostPointContacts each.
    void reserve(int points);

    struct Contact {
        const btCollisionObject* body = nullptr;
        const btCollisionObject* point = nullptr;
        int part = 0;  ///< index of the body's part
        int face = 0;  ///< contacts with the same face start from its last impulse
        Vec3 n_W = Vec3::UnitZ();
        double gap = 0;
        double friction = 0;
        double compliance = 0;  ///< [m/s per N*s]
    };
    static double compliance(const btManifoldPoint& point) noexcept {
        return point.m_contactMotion1;  // a field that only Bullet's own solver uses
    }
    /// Adds a contact for the next take(). The contact is left out if no memory is left.
    void add(const Contact& contact) noexcept;
    /// Appends the manifolds of all contacts added since the last call to `out`, and forgets all
    /// others.
    void take(std::vector<btPersistentManifold*>& out) noexcept;
    /// Forgets all contacts and their impulses.
    void forget() noexcept;
    /// Calls `use` with every manifold.
    template <class Use>
    void for_each_manifold(const Use& use) const {
        for (const Slot& slot : slots_) use(*slot.manifold);
    }
    /// To be called after bodies have moved by h [s]. A point fixed to a turning body moves along
    /// an arc, whereas a point proxy's own step is along the tangent. Returns the difference
    /// between the two, averaged over the bodies that press on the point and weighted by pressure
    /// [m].
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
