// The record of one contact point. Contacts are found once per step by the dynamics module; frames
// and fingers read the records.
#pragma once

#include "base/geometry.h"

namespace dihaptic::contact {

/// Index of a body in a World; scene bodies come first, followed by the proxies of the fingers.
struct BodyIndex {
    int value = -1;
    bool valid() const { return value >= 0; }
    auto operator<=>(const BodyIndex&) const = default;
};

struct Contact {
    BodyIndex a;
    BodyIndex b;
    Vec3 p_WC = Vec3::Zero();   ///< contact point on the surface of b [m]
    Vec3 n_W = Vec3::UnitZ();   ///< unit normal, from a to b
    double gap = 0;             ///< distance before the step, negative if the bodies penetrate [m]
    double friction = 0;        ///< friction coefficient of this pair of surfaces
    double normal_force = 0;    ///< force that pushes the bodies apart, averaged over the step,
                                ///< never negative [N]
    Vec3 f_B_W = Vec3::Zero();  ///< total force exerted by a on b, averaged over the step [N]
    double moment = 0;          ///< moment of a on b about the normal, averaged over the step [N*m]
};

}  // namespace dihaptic::contact
