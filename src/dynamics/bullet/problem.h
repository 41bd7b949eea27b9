// ManifoldProblem converts Bullet's contact manifolds to a contact problem, and stores the answer
// with the manifolds' points.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <span>
#include <vector>

#include "contact/problem.h"
#include "dynamics/bullet/joints.h"

namespace dihaptic::dynamics {

struct Carried;

/// A contact problem built from manifolds; the impulses of the last step are the starting point.
class ManifoldProblem {
  public:
    /// Reserves memory for this many contact points. `torsion_radii` holds the torsion radius of
    /// each body, by user index; a pair of bodies has the larger of their radii [m].
    void reserve(std::vector<double> torsion_radii, int contacts, size_t joint_elements);

    /// Builds the problem of the given bodies, which can all move, with their current velocities.
    /// `inverse_mass` holds the values for all bodies, by user index. A gap becomes the velocity
    /// that closes it in one step of h; of a penetration, the fraction `recovery` is removed per
    /// step.
    void build(std::span<btCollisionObject*> bodies, std::span<const contact::Mat6> inverse_mass,
               std::span<btPersistentManifold*> manifolds, double h, double recovery,
               bool warm_start) noexcept;

    /// To be called once the problem is solved. Changes the problem so that contacts which touched
    /// in the step and bounce must separate at the speed given by Newton's law, while all other
    /// conditions must hold as before. The answer to the changed problem gives the velocities after
    /// the step. `by_loads` is the change in all bodies' velocities due to the step's loads, by
    /// user index. Returns false if nothing bounces.
    bool bounce(std::span<btPersistentManifold*> manifolds,
                std::span<const contact::Vec6> by_loads) noexcept;

    /// Stores a copy of the impulses for mix().
    void keep() noexcept;
    /// Interpolates between the kept impulses (share 0) and the current impulses (share 1).
    void mix(double share) noexcept;

    /// Adds rows for joints between bodies of the problem, starting from the impulses of the last
    /// step if `warm_start`, otherwise from zero.
    void add_joints(Joints& joints, std::span<const size_t> which, double h,
                    bool warm_start) noexcept;
    /// Like Joints::guess().
    double guess(Joints& joints, std::span<const size_t> which, double h,
                 std::span<const contact::Vec6> change) noexcept;
    /// Imposes the joints' equations only on the velocities (Joints::hold).
    void hold(Joints& joints, std::span<const size_t> which, double h) noexcept;

    /// Sets the angular velocity that a body of the problem has before the impulses.
    void set_free_turn(size_t body, const Vec3& w_W) noexcept { problem_.bodies[body].w_W = w_W; }

    const contact::ContactProblem& problem() const noexcept { return problem_; }
    std::span<contact::Impulse> impulses() noexcept { return impulses_; }
    std::span<Vec3> joint_impulses() noexcept { return joint_impulses_; }

    /// Stores the impulses of the joints, and the velocity change of each of the problem's bodies,
    /// in `joints`.
    void store(Joints& joints, std::span<const size_t> which, std::span<const contact::Vec6> change,
               double h) const noexcept;
    /// Stores the impulses in the points of the manifolds.
    void store(std::span<btPersistentManifold*> manifolds) const noexcept;

  private:
    void read_impulses(std::span<btPersistentManifold*> manifolds) noexcept;
    contact::ContactProblem problem_;
    std::vector<contact::Impulse> impulses_;
    std::vector<Vec3> joint_impulses_;
    std::vector<contact::Impulse> kept_impulses_;
    std::vector<Vec3> kept_joint_impulses_;
    std::vector<double> leaves_;  // normal velocities of bouncing contacts after the step [m/s]
    std::vector<int> index_;      // for each body, by user index: its index in the problem
    std::vector<double> torsion_radii_;
};

/// Moves the normal impulses from which a step starts a tenth of the way towards equal shares
/// within a contact patch. Which of a pad's four corners carries its load is undetermined when the
/// pad cannot turn: every distribution solves the step, and any solver stays near its starting
/// distribution. A distribution left over from a transient would persist, until one corner carries
/// the whole load and the held object turns about that corner. Where the load does determine the
/// distribution, the solve restores it.
void even_out(btPersistentManifold& manifold) noexcept;

}  // namespace dihaptic::dynamics
