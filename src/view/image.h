// Pictures in memory, and as PNG files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace dihaptic::view {

struct Image {
    int width = 0;
    int height = 0;
    std::vector<uint8_t> rgb;  ///< sRGB, three bytes a pixel, rows from top to bottom

    const uint8_t* at(int x, int y) const {
        return &rgb[3 *
                    (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x))];
    }
};

/// Writes a PNG file, which is either whole or not there. Throws Error when it cannot.
void write_png(const Image& image, const std::string& file);
/// Throws Error when it is no PNG file.
Image read_png(const std::string& file);

}  // namespace dihaptic::view
