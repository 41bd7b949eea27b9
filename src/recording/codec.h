// Encodes frames as bytes, field by field in the order of Frame::visit(), little-endian. A body is
// written only when it has changed: decoding over the previous frame keeps the other bodies
// (decoder.h).
#pragma once

#include <cstddef>
#include <span>

#include "frame/frame.h"

namespace dihaptic::recording {

/// Numbers of items in a frame; fixed for a session.
struct Layout {
    size_t fingers = 0;
    size_t bodies = 0;
    size_t turns = 0;  ///< fingers whose devices measure orientation
    size_t joints = 0;
};

/// Size of the largest frame with this many contacts [bytes].
size_t most_bytes(const Layout& layout, size_t contacts);

/// The bodies in an encoded frame. A frame with all bodies is readable without earlier frames.
enum class Bodies { changed, all };

/// Encodes the frame into `out`, and returns the number of bytes, or 0 if it does not fit.
/// Allocates nothing.
size_t encode(const frame::Frame& frame, std::span<std::byte> out,
              Bodies bodies = Bodies::changed) noexcept;

}  // namespace dihaptic::recording
