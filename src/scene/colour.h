// Colours in the notation of files: "#rrggbb".
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/diagnostics.h"

namespace dihaptic::scene {

/// 65536 red + 256 green + blue of "#rrggbb"; nullopt for any other text.
std::optional<int32_t> colour_of(const std::string& text);

/// The same, but -1 for an empty text, and for a text that is not a colour, with a report to
/// `diagnostics`.
int32_t read_colour(const std::string& text, const Place& place, Diagnostics& diagnostics);

}  // namespace dihaptic::scene
