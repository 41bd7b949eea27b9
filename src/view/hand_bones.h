// Places the bones of a simplified right hand, given the recorded positions of the thumb and the
// index finger.
#pragma once

#include <vector>

#include "base/geometry.h"

namespace dihaptic::view {

/// A straight part of the hand, with rounded ends.
struct Bone {
    Vec3 from;
    Vec3 to;
    double radius;
};

/// Returns the forearm, the palm, and the bones of five fingers, each finger from root to tip.
/// `thumb`, `index`: points that these fingers touch, in W [m]. The hand comes from the person's
/// side (-y) and slightly from above; the other fingers follow the index finger. The lengths of
/// bones are fixed, so if the two points are too far apart for a hand, the fingers do not reach
/// them. Returns no bones if the points are equal or if one of them is unknown.
std::vector<Bone> hand_bones(const Vec3& thumb, const Vec3& index);

}  // namespace dihaptic::view
