// Connects dynamics/polyhedron.h to Bullet: the collision algorithm for pairs of boxes and hulls,
// and for either against a plane. Contacts keep the impulses of the nearest point of the last step,
// for warm starts.
#pragma once

#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <memory>
#include <vector>

#include "dynamics/polyhedron.h"

namespace dihaptic::dynamics {

/// Hulls with more edges than this use Bullet's distance algorithm, as the number of edge pairs
/// grows with the square.
constexpr size_t kMostEdges = 64;

/// Registers the algorithm. Shapes that are polyhedra have a user pointer: a `const Polyhedron*` in
/// the shape's frame.
class PolyhedronAlgorithms {
  public:
    /// `step` is read at each use: duration of the coming step [s].
    PolyhedronAlgorithms(btCollisionDispatcher& dispatcher, const double& step);
    ~PolyhedronAlgorithms();

  private:
    struct Create;
    std::vector<std::unique_ptr<Create>> creators_;
};

}  // namespace dihaptic::dynamics
