// Colours as files have them: "#rrggbb".
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/diagnostics.h"

namespace dihaptic::scene {

/// 65536 red + 256 green + blue of "#rrggbb"; none of any other text.
std::optional<int32_t> colour_of(const std::string& text);

/// The same; -1 for an empty text, and for one that is not a colour, which is reported to
/// `diagnostics`.
int32_t read_colour(const std::string& text, const Place& place, Diagnostics& diagnostics);

}  // namespace dihaptic::scene
