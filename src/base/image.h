// Pictures in memory and in PNG files. A picture for display is read as it is meant to look. If the
// grey levels are data, such as heights, they are read as stored, without gamma.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace dihaptic {

struct Image {
    int width = 0;
    int height = 0;
    std::vector<uint8_t> rgb;   ///< sRGB, three bytes per pixel, rows from top to bottom
    std::string checksum = {};  ///< checksum of the picture's file as it was read (base/checksum.h)

    const uint8_t* at(int x, int y) const {
        return &rgb[3 *
                    (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x))];
    }
};

/// Writes a PNG file, which appears under its name only when it is complete. Throws Error if the
/// file cannot be written.
void write_png(const Image& image, const std::string& file);
/// Reads a picture for display. Throws Error if the file is not a PNG file or is very large. 16-bit
/// samples are also interpreted as sRGB, unless the file says otherwise (gAMA). Transparent pixels
/// are drawn on black.
Image read_png(const std::string& file);

/// A picture whose grey levels represent numbers.
struct GreyImage {
    int width = 0;
    int height = 0;
    std::vector<float> grey;    ///< from 0 (black) to 1 (white): mean of the colours as stored
    std::string checksum = {};  ///< checksum of the picture's file as it was read (base/checksum.h)
};
/// Reads a picture whose grey levels are numbers. Throws Error in the same cases as read_png(), and
/// also if a pixel is not opaque, because a number cannot be half transparent.
GreyImage read_grey_png(const std::string& file);

}  // namespace dihaptic
