// A simulated person's sensation of forces that push the hand. The springs and dampers of the hand
// yield to a push that the hand does not oppose, so their strain reveals the push:
//
//     f_push = k (x - x_0) + c (v - v_0) + f_expected        (+ m a, which is small)
//
// Here x is the position of the hand, x_0 its position if the push were as expected, v and v_0 are
// the corresponding velocities, k and c the stiffness and damping of the hand, and m is the mass of
// the handle. In a channel, x stays on the line: whatever force the hand exerts, the push seems to
// be as expected, apart from the yielding of the walls.
#pragma once

#include "base/geometry.h"

namespace dihaptic::person {

/// The strain that the person feels in one tick.
struct Strain {
    Vec3 hand = Vec3::Zero();    ///< felt position of the hand: the middle of the handles [m]
    int reach = 0;               ///< number of the reach in which a push was felt; 0 if none
    double time = 0;             ///< [s]
    double speed = 0;            ///< speed along the reach, one lag ago [m/s]
    Vec3 push_W = Vec3::Zero();  ///< f_push, averaged over the fingers [N]
};

}  // namespace dihaptic::person
