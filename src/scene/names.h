// Greatest length of a name of a body, finger or joint [bytes]: names become parts of paths in a
// session's recording.
#pragma once

#include <cstddef>

namespace dihaptic::scene {

constexpr size_t kLongestName = 200;  // [bytes]

}  // namespace dihaptic::scene
