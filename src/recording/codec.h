// Frames as bytes, field by field in the order of Frame::visit(), little-endian. Bodies are written
// when they changed: decoding onto the frame before fills in those that did not (decoder.h).
#pragma once

#include <cstddef>
#include <span>

#include "servo/frame.h"

namespace dihaptic::recording {

/// How many of each there are: fixed for a session.
struct Layout {
    size_t fingers = 0;
    size_t bodies = 0;
    size_t turns = 0;  ///< fingers whose devices measure orientation
};

/// Bytes of the largest frame with so many contacts.
size_t most_bytes(const Layout& layout, size_t contacts);

/// Which bodies an encoded frame has: all of them make it readable without the frames before.
enum class Bodies { changed, all };

/// Writes the frame into `out` and returns how many bytes it took, or 0 when it does not fit.
/// Allocates nothing.
size_t encode(const servo::Frame& frame, std::span<std::byte> out,
              Bodies bodies = Bodies::changed) noexcept;

}  // namespace dihaptic::recording
