// ManifoldProblem turns Bullet's contact manifolds into a contact problem, and stores its answer in
// them.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <span>
#include <vector>

#include "contact/problem.h"

namespace dihaptic::dynamics {

/// A problem made of some manifolds, with the last step's impulses as a start.
class ManifoldProblem {
  public:
    /// Reserves memory for bodies with user indices below `bodies`, and for this many contact
    /// points.
    void reserve(int bodies, int contacts);

    /// Builds the problem of these bodies, which can move, with their present velocities. A gap
    /// becomes the velocity that closes it in one step of h; the share `recovery` of a penetration
    /// is removed per step.
    void build(std::span<btCollisionObject*> bodies, std::span<btPersistentManifold*> manifolds,
               double h, double recovery, bool warm_start) noexcept;

    const contact::ContactProblem& problem() const noexcept { return problem_; }
    std::span<contact::Impulse> impulses() noexcept { return impulses_; }

    /// Stores the impulses in the manifolds.
    void store(std::span<btPersistentManifold*> manifolds) const noexcept;
    /// Residual of the impulses that another solver left in the manifolds.
    double judge(std::span<btPersistentManifold*> manifolds) noexcept;

  private:
    void read_impulses(std::span<btPersistentManifold*> manifolds) noexcept;

    contact::ContactProblem problem_;
    std::vector<contact::Impulse> impulses_;
    std::vector<int> index_;  // index in the problem, by a body's user index
    std::vector<Eigen::Matrix<double, 6, 1>> scratch_;
};

/// Moves the impulses from which a step starts a tenth of the way to equal shares, along the
/// normals within a patch of contacts. Which of a pad's four corners carries its load is
/// undetermined when the pad cannot turn: every distribution solves the step, and any solver stays
/// near the one that it started from. A distribution left by a transient would stay, until one
/// corner carries all and the held object turns about it. Where the load does determine the
/// distribution, the solve restores it.
void even_out(btPersistentManifold& manifold) noexcept;

/// Moment about the normal in the last step [N*m*s]. Bullet has no such value; this member is kept
/// when Bullet replaces a point, and its solver for rigid bodies does not read it.
inline btScalar& torsion_impulse(btManifoldPoint& point) {
    return point.m_prevRHS;
}
inline btScalar torsion_impulse(const btManifoldPoint& point) {
    return point.m_prevRHS;
}
/// Torsion radius of the pair [m].
inline btScalar& torsion_radius(btManifoldPoint& point) {
    return point.m_contactMotion1;
}

}  // namespace dihaptic::dynamics
