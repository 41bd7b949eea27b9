// Whether a frame that was read can be one of its session: what is an index in it points to
// something. A checksum is right also of what was never a frame.
#pragma once

#include "recording/codec.h"

namespace dihaptic::recording {

bool is_possible(const servo::Frame& frame, const Layout& layout) noexcept;

}  // namespace dihaptic::recording
