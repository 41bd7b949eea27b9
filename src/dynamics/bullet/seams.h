// Removes contacts at points inside a body that consists of several parts.
//
// Contacts are found part by part, and a part has faces, edges and corners where it meets other
// parts. These lie inside the body, or within one of its faces. Bodies are nearest to each other at
// such a point only if no part that contains the point is nearer still: since that part is convex,
// the distance decreases all the way from the point to the part's nearest point. The bodies cannot
// first touch at such a point, and its normal belongs to no surface.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <bitset>
#include <span>

#include "dynamics/bullet/shape.h"

namespace dihaptic::dynamics {

/// A manifold between two parts.
struct OfParts {
    btPersistentManifold* manifold = nullptr;
    const CollisionPart* part_0 = nullptr;  ///< part of the manifold's body 0
    const CollisionPart* part_1 = nullptr;
    double nearest = 0;            ///< computed by remove_inner_contacts()
    std::bitset<4> is_inner = {};  ///< its inner points, also computed by remove_inner_contacts()
};

/// Removes the inner points from all manifolds between two bodies. Some manifolds may end up empty.
void remove_inner_contacts(std::span<OfParts> of_two_bodies) noexcept;

}  // namespace dihaptic::dynamics
