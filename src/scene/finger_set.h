// A set of fingers of a scene, given by their indices.
#pragma once

#include <bitset>
#include <cstddef>

namespace dihaptic::scene {

/// Largest number of fingers; a scene with more fingers is refused when it is read.
constexpr size_t kMostFingers = 256;

using FingerSet = std::bitset<kMostFingers>;

/// Whether the set contains a finger. May also be called with an impossible index from a damaged
/// recording.
inline bool contains(const FingerSet& fingers, size_t finger) noexcept {
    return finger < fingers.size() && fingers[finger];
}

inline FingerSet finger_set(size_t finger) {
    return FingerSet{}.set(finger);
}

/// The set of the first `count` fingers.
inline FingerSet first_fingers(size_t count) {
    FingerSet out;
    for (size_t i = 0; i < count && i < out.size(); ++i) out.set(i);
    return out;
}

}  // namespace dihaptic::scene
