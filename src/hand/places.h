// Places each finger in the hand, according to the spec or by default.
#pragma once

#include "hand/spec.h"

namespace dihaptic::hand {

/// One place for each of `fingers`, in order. `side` is a unit vector, or zero for a finger
/// that is the entire hand. Fingers without a place in the spec are on alternate sides along x.
/// Throws Error when the spec names an unknown finger, names a finger twice, or gives one of
/// several fingers no side.
std::vector<FingerPlace> finger_places(const HandSpec& spec,
                                       const std::vector<std::string>& fingers);

}  // namespace dihaptic::hand
