// A picture as a relief: its grey levels are smoothed to a height that has a slope everywhere.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic::scene {

/// Grey values from 0 (black) to 1 (white) that repeat in both directions. Between pixels they are
/// a uniform cubic B-spline (de Boor 1978), which is nowhere higher than the brightest pixel, and
/// whose slope has no jumps.
class ReliefPicture {
  public:
    /// Limits of the pixels along an edge.
    static constexpr int kFewest = 4;
    static constexpr int kMost = 2048;

    struct Value {
        double height = 0;  ///< 0 to 1
        double rise_x = 0;  ///< rise over one pixel to the right,
        double rise_y = 0;  ///< and over one pixel upward
    };

    /// Rows from top to bottom. Needs width x height values, and both edges within the limits.
    ReliefPicture(int width, int height, std::vector<float> grey, std::string checksum = "");

    int width() const noexcept { return width_; }
    int height() const noexcept { return height_; }
    /// Checksum of its file when it was read (base/checksum.h).
    const std::string& checksum() const noexcept { return checksum_; }
    /// The relief at a point `x` pixels to the right of the picture's centre and `y` pixels above
    /// it.
    Value at(double x, double y) const noexcept;
    /// The largest rise over a pixel in any direction, sampled four times per pixel along each
    /// edge.
    double steepest() const noexcept { return steepest_; }

  private:
    int width_;
    int height_;
    std::vector<float> grey_;
    std::string checksum_;
    double steepest_ = 0;
};

/// Reads a PNG file; colours are averaged over their channels. Throws Error, with that place and
/// key, when it is not a PNG file, or is too large or small.
ReliefPicture read_relief(const std::string& file, const Place& place);

}  // namespace dihaptic::scene
