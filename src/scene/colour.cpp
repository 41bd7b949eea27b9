#include "scene/colour.h"

#include <fmt/format.h>

#include "base/number.h"

namespace dihaptic::scene {

std::optional<int32_t> colour_of(const std::string& text) {
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    const auto rgb = whole_number<int32_t>(std::string_view(text).substr(1), 16);
    return rgb && *rgb >= 0 ? rgb : std::nullopt;
}

int32_t read_colour(const std::string& text, const Place& place, Diagnostics& diagnostics) {
    if (text.empty()) return -1;
    if (const std::optional<int32_t> rgb = colour_of(text)) return *rgb;
    diagnostics.error(place, "colour", fmt::format("'{}' is not a colour", text),
                      "Write red, green and blue in hexadecimal, e.g. colour: \"#d55e00\".");
    return -1;
}

}  // namespace dihaptic::scene
