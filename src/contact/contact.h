// The record of one contact point. Contacts are found once per step, by dynamics; frames and
// fingers read these records.
#pragma once

#include "base/geometry.h"

namespace dihaptic::contact {

/// Index of a body in a World; scene bodies come first, then the fingers' proxies.
struct BodyIndex {
    int value = -1;
    bool valid() const { return value >= 0; }
    auto operator<=>(const BodyIndex&) const = default;
};

struct Contact {
    BodyIndex a;
    BodyIndex b;
    Vec3 p_WC = Vec3::Zero();   ///< on b's surface [m]
    Vec3 n_W = Vec3::UnitZ();   ///< unit normal, from a to b
    double gap = 0;             ///< distance before the step; negative: penetration [m]
    double friction = 0;        ///< coefficient of the pair
    double normal_force = 0;    ///< pressing the bodies apart, mean over the step, at least 0 [N]
    Vec3 f_B_W = Vec3::Zero();  ///< total force of a on b, mean over the step [N]
    double moment = 0;          ///< moment of a on b about the normal, mean over the step [N*m]
};

}  // namespace dihaptic::contact
