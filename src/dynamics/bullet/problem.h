// ManifoldProblem turns Bullet's contact manifolds into a contact problem, and stores its answer
// with their points.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <span>
#include <vector>

#include "contact/problem.h"
#include "dynamics/bullet/joints.h"

namespace dihaptic::dynamics {

struct Carried;

/// A problem built from manifolds, with the last step's impulses as a start.
class ManifoldProblem {
  public:
    /// Reserves memory for this many contact points. The torsion radii of all bodies, by user
    /// index, give those of pairs: the larger one is used [m].
    void reserve(std::vector<double> torsion_radii, int contacts, size_t joint_elements);

    /// Builds the problem of these bodies, which can move, with their present velocities;
    /// `inverse_mass` holds the values of all bodies, by user index. A gap becomes the velocity
    /// that closes it in one step of h; the fraction `recovery` of a penetration is removed per
    /// step.
    void build(std::span<btCollisionObject*> bodies, std::span<const contact::Mat6> inverse_mass,
               std::span<btPersistentManifold*> manifolds, double h, double recovery,
               bool warm_start) noexcept;

    /// To be called once the problem is solved: contacts that touched in the step and bounce must
    /// separate at the speed of Newton's law, and all other conditions must hold as before. The
    /// answer of the changed problem gives the velocities after the step. `by_loads` is the change
    /// of all bodies' velocities by the step's loads, by user index. False if nothing bounces.
    bool bounce(std::span<btPersistentManifold*> manifolds,
                std::span<const contact::Vec6> by_loads) noexcept;

    /// Remembers the impulses, for mix().
    void keep() noexcept;
    /// Interpolates from the kept impulses to the present ones by this fraction.
    void mix(double share) noexcept;

    /// Adds rows of joints between bodies of the problem, with the start that was passed to
    /// build().
    void add_joints(Joints& joints, std::span<const size_t> which, double h,
                    bool warm_start) noexcept;
    /// Like Joints::guess().
    double guess(Joints& joints, std::span<const size_t> which, double h,
                 std::span<const contact::Vec6> change) noexcept;
    /// Imposes the joints' equations on the velocities only (Joints::hold).
    void hold(Joints& joints, std::span<const size_t> which, double h) noexcept;

    /// Angular velocity of a body of the problem before the impulses.
    void set_free_turn(size_t body, const Vec3& w_W) noexcept { problem_.bodies[body].w_W = w_W; }

    const contact::ContactProblem& problem() const noexcept { return problem_; }
    std::span<contact::Impulse> impulses() noexcept { return impulses_; }
    std::span<Vec3> joint_impulses() noexcept { return joint_impulses_; }

    /// Stores with the joints their impulses, and `change`, the change of velocity of each of the
    /// problem's bodies.
    void store(Joints& joints, std::span<const size_t> which, std::span<const contact::Vec6> change,
               double h) const noexcept;
    /// Stores the impulses with the manifolds' points.
    void store(std::span<btPersistentManifold*> manifolds) const noexcept;

  private:
    void read_impulses(std::span<btPersistentManifold*> manifolds) noexcept;
    contact::ContactProblem problem_;
    std::vector<contact::Impulse> impulses_;
    std::vector<Vec3> joint_impulses_;
    std::vector<contact::Impulse> kept_impulses_;
    std::vector<Vec3> kept_joint_impulses_;
    std::vector<double> leaves_;  // normal velocities after the step, for bouncing contacts [m/s]
    std::vector<int> index_;      // index in the problem, by a body's user index
    std::vector<double> torsion_radii_;
};

/// Moves the starting impulses of a step along the normals a tenth of the way towards equal shares
/// within a patch of contacts. Which of a pad's four corners carries its load is undetermined when
/// the pad cannot turn: every distribution solves the step, and any solver stays near its starting
/// distribution. A distribution left by a transient would stay, until one corner carries all and
/// the held object turns about it. Where the load does determine the distribution, the solve
/// restores it.
void even_out(btPersistentManifold& manifold) noexcept;

}  // namespace dihaptic::dynamics
