// Interprets a picture as a relief: its grey levels are smoothed to a height that has a slope
// everywhere.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic::scene {

/// A relief of grey values from 0 (black) to 1 (white) that repeats in both directions. Between
/// pixels, the height is a uniform cubic B-spline (de Boor 1978). It is nowhere higher than the
/// brightest pixel, and its slope is continuous.
class ReliefPicture {
  public:
    /// Limits on the number of pixels along an edge.
    static constexpr int kFewest = 4;
    static constexpr int kMost = 2048;

    struct Value {
        double height = 0;  ///< from 0 to 1
        double rise_x = 0;  ///< rise over one pixel to the right
        double rise_y = 0;  ///< rise over one pixel upwards
    };

    /// `grey` has width x height values, in rows from top to bottom. Both edges must be within the
    /// limits.
    ReliefPicture(int width, int height, std::vector<float> grey, std::string checksum = "");

    int width() const noexcept { return width_; }
    int height() const noexcept { return height_; }
    /// Checksum of the picture's file when it was read (base/checksum.h).
    const std::string& checksum() const noexcept { return checksum_; }
    /// The relief at a point `x` pixels to the right of the centre of the picture and `y` pixels
    /// above it.
    Value at(double x, double y) const noexcept;
    /// The steepest rise over one pixel in any direction, found by sampling four times per pixel
    /// along each edge.
    double steepest() const noexcept { return steepest_; }

  private:
    int width_;
    int height_;
    std::vector<float> grey_;
    std::string checksum_;
    double steepest_ = 0;
};

/// Reads a PNG file, averaging over its colour channels. Throws Error, at that place and for that
/// key, if the file is not a PNG file, or is too large or too small.
ReliefPicture read_relief(const std::string& file, const Place& place);

}  // namespace dihaptic::scene
