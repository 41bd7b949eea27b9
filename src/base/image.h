// A picture in memory, and its PNG file. A picture for display is read as it is meant to
// look. A picture whose grey levels are data, such as heights, is read as stored, without gamma.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace dihaptic {

struct Image {
    int width = 0;
    int height = 0;
    std::vector<uint8_t> rgb;   ///< sRGB, three bytes per pixel, rows from top to bottom
    std::string checksum = {};  ///< checksum of the file from which it was read (base/checksum.h)

    const uint8_t* at(int x, int y) const {
        return &rgb[3 *
                    (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x))];
    }
};

/// Writes a PNG file, which appears only when it is whole. Throws Error when it cannot be written.
void write_png(const Image& image, const std::string& file);
/// Throws Error when the file is not a PNG file, or is very large. 16-bit samples are interpreted
/// as sRGB too, unless the file says otherwise (gAMA); transparent pixels are drawn on black.
Image read_png(const std::string& file);

/// A picture whose grey levels are numbers.
struct GreyImage {
    int width = 0;
    int height = 0;
    std::vector<float> grey;    ///< from 0 (black) to 1 (white): mean of the colours as stored
    std::string checksum = {};  ///< checksum of the file from which it was read (base/checksum.h)
};
/// Throws Error like read_png(), and also if a pixel is not opaque, because a number cannot be
/// half transparent.
GreyImage read_grey_png(const std::string& file);

}  // namespace dihaptic
