// Colours in the notation used in files: "#rrggbb".
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/diagnostics.h"

namespace dihaptic::scene {

/// Converts "#rrggbb" to 65536 red + 256 green + blue; nullopt if the text is not of this form.
std::optional<int32_t> colour_of(const std::string& text);

/// Like colour_of(), but returns -1 if the text is empty or is not a colour. The latter is reported
/// to `diagnostics`.
int32_t read_colour(const std::string& text, const Place& place, Diagnostics& diagnostics);

}  // namespace dihaptic::scene
