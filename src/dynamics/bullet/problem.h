// Bullet's contact manifolds as a contact problem, and its answer back into them.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <span>
#include <vector>

#include "contact/problem.h"

namespace dihaptic::dynamics {

/// A problem of some manifolds, with the last step's impulses as a start.
class ManifoldProblem {
  public:
    /// Memory for user indices of bodies below `bodies`, and so many contact points.
    void reserve(int bodies, int contacts);

    /// Bodies that can move, by their velocities as they are; gaps become velocities that close
    /// them in one step of h, and a penetration is left to the share `recovery`.
    void build(std::span<btCollisionObject*> bodies, std::span<btPersistentManifold*> manifolds,
               double h, double recovery, bool warm_start) noexcept;

    const contact::ContactProblem& problem() const noexcept { return problem_; }
    std::span<contact::Impulse> impulses() noexcept { return impulses_; }

    /// The impulses into the manifolds.
    void store(std::span<btPersistentManifold*> manifolds) const noexcept;
    /// The impulses that the manifolds hold, as another solver left them; their residual.
    double judge(std::span<btPersistentManifold*> manifolds) noexcept;

  private:
    void read_impulses(std::span<btPersistentManifold*> manifolds) noexcept;

    contact::ContactProblem problem_;
    std::vector<contact::Impulse> impulses_;
    std::vector<int> index_;  // in the problem, by a body's user index
    std::vector<Eigen::Matrix<double, 6, 1>> scratch_;
};

/// Moves the impulses that a step starts from, those of a patch of contacts along their normals, a
/// tenth of the way to an even share. Which of a pad's four corners carries its load is
/// undetermined when the pad cannot turn: every share solves the step, and any solver stays near
/// the one that it started from. Shares that a transient left would stay, until one corner carries
/// all and the held object turns about it. Shares that the load does determine are restored by the
/// solve itself.
void even_out(btPersistentManifold& manifold) noexcept;

/// Moment about the normal in the last step [N*m*s]. Bullet knows none; this is a member that it
/// keeps when it replaces a point, and that its solver for rigid bodies does not read.
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
