// A simulated person's sensation of forces that push the hand. The hand's springs and dampers yield
// to a push that the hand does not oppose, so their strain reveals the push:
//
//     f_push = k (x - x_0) + c (v - v_0) + f_expected        (+ m a, which is small)
//
// with x the hand's position, x_0 its position if the push were as expected, k and c its stiffness
// and damping, and m the handle's mass. In a channel x stays on the line: whatever force the hand
// exerts, the push seems to be the expected one, except for the walls' yielding.
#pragma once

#include "base/geometry.h"

namespace dihaptic::person {

/// The strain in one tick.
struct Strain {
    Vec3 hand = Vec3::Zero();    ///< felt position of the hand: middle of the handles [m]
    int reach = 0;               ///< number of the reach in which a push was felt; 0: none
    double speed = 0;            ///< along the reach [m/s]
    Vec3 push_W = Vec3::Zero();  ///< f_push, mean over the fingers [N]
};

}  // namespace dihaptic::person
