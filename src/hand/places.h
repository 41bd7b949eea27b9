// Where each finger is in the hand, as the spec says or by default.
#pragma once

#include "hand/spec.h"

namespace dihaptic::hand {

/// One place for each of `fingers`, in their order; `side` is a unit vector, or zero where the
/// finger is the hand. Without a word on it, fingers stand on alternate sides along x. Throws Error
/// when the spec names a finger that there is not, one twice, or one without a side.
std::vector<FingerPlace> finger_places(const HandSpec& spec,
                                       const std::vector<std::string>& fingers);

}  // namespace dihaptic::hand
