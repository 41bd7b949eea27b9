// Connects dynamics/polyhedron.h and dynamics/round.h to Bullet: the collision algorithm for all
// pairs of shapes except hulls with too many edges. Contacts keep the impulses of the nearest point
// of the last step, for warm starts.
#pragma once

#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <memory>
#include <vector>

#include "dynamics/polyhedron.h"

namespace dihaptic::dynamics {

/// Hulls with more edges than this use Bullet's distance algorithm, because the number of edge
/// pairs grows with the square of the edges.
constexpr size_t kMostEdges = 64;

/// Registers the algorithm. The user pointer of shapes is their CollisionPart.
class ContactAlgorithms {
  public:
    /// `step` is read at each use: duration of the coming step [s].
    ContactAlgorithms(btCollisionDispatcher& dispatcher, const double& step);
    ~ContactAlgorithms();

  private:
    struct Create;
    std::vector<std::unique_ptr<Create>> creators_;
};

}  // namespace dihaptic::dynamics
