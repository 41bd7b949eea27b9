// A contact problem in the form of Bullet's sequential-impulse solver: made once, then solved any
// number of times from the same velocities and impulses.
//
// Bullet uses contact points only relative to the bodies' centres, so all bodies are at the
// origin, with each contact point at its position relative to its body's centre. The gap for Bullet
// is the gap that the bias closes in one step.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <span>
#include <vector>

#include "contact/problem.h"

namespace dihaptic::bench {

class BulletProblem {
  public:
    BulletProblem(const contact::ContactProblem& problem, std::span<const contact::Impulse> start);

    /// Restores velocities and impulses to those before a solve. Bullet uses only the normal
    /// impulses of the start, and always starts friction at zero.
    void reset();
    /// Solves with exactly `iterations` iterations, two directions of friction, and a warm start.
    void solve(btSequentialImpulseConstraintSolver& solver, int iterations);
    /// The impulses of the last solve.
    std::vector<contact::Impulse> impulses() const;

  private:
    const contact::ContactProblem& problem_;
    std::vector<contact::Impulse> start_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;  // the fixed body is last
    std::vector<btCollisionObject*> moving_;
    std::vector<std::unique_ptr<btPersistentManifold>> manifolds_;
    std::vector<btPersistentManifold*> manifold_list_;
};

}  // namespace dihaptic::bench
