// Checks whether a frame that was read from a log can belong to its session: every index in the
// frame must refer to an existing item. A correct checksum does not guarantee this, since the data
// may never have been a valid frame.
#pragma once

#include "recording/codec.h"

namespace dihaptic::recording {

bool is_possible(const frame::Frame& frame, const Layout& layout) noexcept;

}  // namespace dihaptic::recording
