// A name of a body, finger or joint may have so many bytes: it becomes a part of paths in a
// session's recording.
#pragma once

#include <cstddef>

namespace dihaptic::scene {

constexpr size_t kLongestName = 200;  // [bytes]

}  // namespace dihaptic::scene
