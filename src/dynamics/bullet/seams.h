// Removes contacts at points inside a body of several parts.
//
// Contacts are found part by part, and a part has faces, edges and corners where it meets others:
// inside the body, or within one of its faces. Bodies are nearest to each other at such a point
// only if no part that contains the point is nearer still: that part is convex, so the distance
// only falls on the way from the point to that part's nearest point. The bodies cannot first touch
// at such a point, and its normal belongs to no surface.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <bitset>
#include <span>

#include "dynamics/bullet/shape.h"

namespace dihaptic::dynamics {

/// A manifold of two parts.
struct OfParts {
    btPersistentManifold* manifold = nullptr;
    const CollisionPart* part_0 = nullptr;  ///< of its body 0
    const CollisionPart* part_1 = nullptr;
    double nearest = 0;            ///< result of remove_inner_contacts()
    std::bitset<4> is_inner = {};  ///< its inner points, likewise a result
};

/// Removes inner points from the manifolds of two bodies, which can leave some manifolds empty.
void remove_inner_contacts(std::span<OfParts> of_two_bodies) noexcept;

}  // namespace dihaptic::dynamics
