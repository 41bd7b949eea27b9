// Frames as bytes, field by field in the order of Frame::visit(), little-endian. Bodies are written
// when they changed: decoding onto the frame before fills in those that did not.
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

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

/// Fields that an older log does not have, each as its line of the schema.
using MissingFields = std::set<std::string>;

/// Reads a frame onto the one before it; false when the bytes are no frame of this layout. Fields
/// that are missing stay as they are.
bool decode(std::span<const std::byte> in, const Layout& layout, servo::Frame& frame,
            const MissingFields& missing = {});

/// Names, types and units of all fields, a line each: logs of another version are told apart by it.
std::string schema();

/// What a log with this schema lacks of our fields. nullopt: it has others, or in another order,
/// and cannot be read.
std::optional<MissingFields> missing_fields(const std::string& recorded_schema);

}  // namespace dihaptic::recording
