// Determines the place of each finger in the hand, from the spec or by default.
#pragma once

#include "hand/spec.h"

namespace dihaptic::hand {

/// Returns one place for each of `fingers`, in order. `side` is a unit vector, or zero for a finger
/// that is the entire hand. Fingers that have no place in the spec are put on alternate sides along
/// x. Throws Error if the spec names an unknown finger, names a finger twice, or does not give a
/// side to one of several fingers.
std::vector<FingerPlace> finger_places(const HandSpec& spec,
                                       const std::vector<std::string>& fingers);

}  // namespace dihaptic::hand
