// What a simulated person feels of the forces that push the hand. The hand's springs and dampers
// yield to a push that it does not press against, so their strain reveals the push:
//
//     f_push = k (x - x_0) + c (v - v_0) + f_expected        (+ m a, which is small)
//
// with x where the hand is, x_0 where it would be if the push were as expected, k and c its
// stiffness and damping, and m the handle's mass. In a channel x stays on the line: whatever the
// hand presses with, the push seems to be the expected one, except for what the walls yield.
#pragma once

#include "base/geometry.h"

namespace dihaptic::person {

/// In one tick.
struct Strain {
    Vec3 hand = Vec3::Zero();    ///< where the hand is felt to be: middle of the handles [m]
    int reach = 0;               ///< number of the reach in which a push was felt; 0: none was
    double speed = 0;            ///< along the reach [m/s]
    Vec3 push_W = Vec3::Zero();  ///< f_push, mean over the fingers [N]
};

}  // namespace dihaptic::person
