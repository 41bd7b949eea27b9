// Encodes frames as little-endian bytes, field by field, in the order of Frame::visit(). A body is
// written only when it has changed: the decoder keeps the previous frame's values for all other
// bodies (decoder.h).
#pragma once

#include <cstddef>
#include <span>

#include "frame/frame.h"

namespace dihaptic::recording {

/// Numbers of items in a frame, which are fixed for a session.
struct Layout {
    size_t fingers = 0;
    size_t bodies = 0;
    size_t turns = 0;  ///< number of fingers whose devices measure orientation
    size_t joints = 0;
};

/// Size of the largest frame with this many contacts [bytes].
size_t most_bytes(const Layout& layout, size_t contacts);

/// Which bodies an encoded frame contains. A frame with all bodies can be decoded without earlier
/// frames.
enum class Bodies { changed, all };

/// Encodes the frame into `out`. Returns the number of bytes written, or 0 if the frame does not
/// fit. Does not allocate memory.
size_t encode(const frame::Frame& frame, std::span<std::byte> out,
              Bodies bodies = Bodies::changed) noexcept;

}  // namespace dihaptic::recording
