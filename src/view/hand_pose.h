// Poses a right hand, given the recorded positions of the thumb and the index finger.
#pragma once

#include <array>
#include <optional>

#include "base/geometry.h"

namespace dihaptic::view {

struct HandPose {
    struct Finger {
        std::array<Vec3, 4> joints;  ///< from the root to the middle of the fingertip [m]
        Vec3 back;                   ///< direction in which the bent finger bulges (unit vector)
    };
    /// x from the thumb to the index finger, y to the wrist, z out of the palm. The origin lies
    /// near the roots of the fingers.
    Pose palm;
    std::array<Finger, 5> fingers;  ///< the thumb first
};

/// Distance from the middle of a fingertip to the skin that touches [m].
constexpr double kPad = 0.006;

/// The joints of a hand that is 19 cm long and open, with straight fingers that are spread apart.
/// Its palm is at the identity.
const HandPose& open_hand();

/// The pose of a hand that grips. `thumb`, `index`: points that these fingers touch, in W [m]. The
/// hand comes from the person's side (-y) and slightly from above; the other fingers follow the
/// index finger. The lengths of bones are fixed, so if the two points are too far apart for a hand,
/// the fingers do not reach them. Returns nullopt if the points are equal or if one is unknown.
std::optional<HandPose> hand_pose(const Vec3& thumb, const Vec3& index);

}  // namespace dihaptic::view
