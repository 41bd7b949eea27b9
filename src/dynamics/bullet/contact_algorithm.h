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
