// Places the bones of a simple right hand, given the recorded thumb and index finger.
#pragma once

#include <vector>

#include "base/geometry.h"

namespace dihaptic::view {

/// A straight part of the hand, with round ends.
struct Bone {
    Vec3 from;
    Vec3 to;
    double radius;
};

/// The forearm, the palm, and the bones of five fingers, each from its root to its tip. `thumb`,
/// `index`: points that these fingers touch, in W [m]. The hand comes from the person's side (-y)
/// and a little from above; the other fingers follow the index finger. Bones keep their lengths, so
/// if the two points are too far apart for a hand, the fingers end short of them. Empty if both
/// points are equal, or if one is unknown.
std::vector<Bone> hand_bones(const Vec3& thumb, const Vec3& index);

}  // namespace dihaptic::view
