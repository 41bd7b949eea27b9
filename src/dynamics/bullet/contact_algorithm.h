// Connects dynamics/polyhedron.h and dynamics/round.h to Bullet: they provide the collision
// algorithm for all pairs of shapes except hulls with too many edges. For warm starts, each contact
// keeps the impulses of the nearest point of the last step.
#pragma once

#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <memory>
#include <vector>

#include "dynamics/polyhedron.h"

namespace dihaptic::dynamics {

/// Hulls with more edges than this use Bullet's distance algorithm, because the number of edge
/// pairs grows with the square of the number of edges.
constexpr size_t kMostEdges = 64;

struct CollisionPart;

/// The algorithm of two parts of our own (CollisionPart::is_own).
class OwnAlgorithm : public btActivatingCollisionAlgorithm {
  public:
    /// Whether the parts were so far apart when they were last examined that they cannot have
    /// contacts now: they have not moved far enough since, and will not in the step.
    bool stay_apart(const CollisionPart& a, const CollisionPart& b) const noexcept;
    /// Moves the contacts along with the parts instead of examining them, if there are any and
    /// neither part has moved much since the last examination. Returns whether it did.
    bool carry(const CollisionPart& a, const CollisionPart& b) noexcept;

  protected:
    OwnAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                 const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                 const double& step)
        : btActivatingCollisionAlgorithm(info, a, b), manifold_(info.m_manifold), step_(step) {}

    btPersistentManifold* manifold_;
    const double& step_;
    double examined_at_ = 0;  // sum of both parts' ways at the last examination [m]
    /// The sum of both parts' ways (CollisionPart::way) up to which they keep their distance; the
    /// contacts' margin is not taken off yet [m].
    double apart_until_ = 0;
};

/// Registers the collision algorithm with Bullet. The user pointer of each shape must be its
/// CollisionPart.
class ContactAlgorithms {
  public:
    /// `step`, the duration of the coming step [s], is read at each use.
    ContactAlgorithms(btCollisionDispatcher& dispatcher, const double& step);
    ~ContactAlgorithms();

  private:
    struct Create;
    std::vector<std::unique_ptr<Create>> creators_;
};

}  // namespace dihaptic::dynamics
