// A contact problem as Bullet's sequential-impulse solver takes it: made once, then solved as often
// as one likes from the same velocities and impulses.
//
// Bullet sees bodies and contact points only relative to each other's centres, so all bodies stand
// at the origin, each contact point where it is from its body's centre. A gap is what the bias
// closes in one step.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <span>
#include <vector>

#include "contact/problem.h"

namespace dihaptic::measure {

class BulletProblem {
  public:
    BulletProblem(const contact::ContactProblem& problem, std::span<const contact::Impulse> start);

    /// Velocities and impulses as they were before a solve. Of the start Bullet takes the normal
    /// impulses; friction it always starts from zero.
    void reset();
    /// So many iterations, neither more nor less, with two directions of friction and warm starts.
    void solve(btSequentialImpulseConstraintSolver& solver, int iterations);
    /// The impulses of the last solve.
    std::vector<contact::Impulse> impulses() const;

  private:
    const contact::ContactProblem& problem_;
    std::vector<contact::Impulse> start_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;  // the fixed one last
    std::vector<btCollisionObject*> moving_;
    std::vector<std::unique_ptr<btPersistentManifold>> manifolds_;
    std::vector<btPersistentManifold*> manifold_list_;
};

}  // namespace dihaptic::measure
