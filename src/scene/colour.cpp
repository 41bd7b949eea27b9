#include "scene/colour.h"

#include <fmt/format.h>

#include <charconv>

namespace dihaptic::scene {

int32_t read_colour(const std::string& text, const Place& place, Diagnostics& diagnostics) {
    if (text.empty()) return -1;
    int32_t rgb = -1;
    const char* const end = text.data() + text.size();
    const bool starts = text.size() == 7 && text[0] == '#';
    const auto [at, error] = std::from_chars(text.data() + 1, end, rgb, 16);
    if (starts && error == std::errc() && at == end && rgb >= 0) return rgb;
    diagnostics.error(place, "colour", fmt::format("'{}' is no colour", text),
                      "Write red, green and blue in hexadecimal, e.g. colour: \"#d55e00\".");
    return -1;
}

}  // namespace dihaptic::scene
