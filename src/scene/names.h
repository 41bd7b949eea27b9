// Maximum length of the name of a body, finger or joint [bytes]. It is limited because names become
// parts of paths in the recording of a session.
#pragma once

#include <cstddef>

namespace dihaptic::scene {

constexpr size_t kLongestName = 200;  // [bytes]

}  // namespace dihaptic::scene
