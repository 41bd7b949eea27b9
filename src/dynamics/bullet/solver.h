// SequentialImpulse is Bullet's sequential-impulse solver (Catto 2005), with its working memory
// reserved, and with its iterations counted.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <span>
#include <vector>

#include "contact/contact.h"
#include "dynamics/settings.h"

namespace dihaptic::dynamics {

class SequentialImpulse : private btSequentialImpulseConstraintSolver {
  public:
    void reserve(int bodies, int contacts);

    /// Changes the bodies' velocities so that the contacts hold; the manifolds keep the impulses.
    /// Returns the number of iterations.
    int solve(std::span<btCollisionObject*> bodies, std::span<btPersistentManifold*> manifolds,
              const Settings& settings, double h, btDispatcher& dispatcher);

  private:
    void convertContacts(btPersistentManifold** manifolds, int manifold_count,
                         const btContactSolverInfo& info) override;
    btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                  btPersistentManifold** manifolds, int manifold_count,
                                  btTypedConstraint** constraints, int constraint_count,
                                  const btContactSolverInfo& info, btIDebugDraw* draw) override;
    /// Removes friction from contacts whose normal impulse is zero; returns the largest change of
    /// velocity, squared.
    btScalar release_friction();
    void apply(const btSolverConstraint& row, btScalar impulse);

    std::vector<btVector3> last_friction_;  // by contact, impulse of the last step on body 0
    int iterations_ = 0;
};

}  // namespace dihaptic::dynamics
