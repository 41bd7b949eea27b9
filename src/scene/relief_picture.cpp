#include "scene/relief_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scene/picture.h"

namespace dihaptic::scene {
namespace {

/// The weights of four pixels at a distance t beyond the second one, and the derivatives of these
/// weights.
struct Weights {
    std::array<double, 4> of{};
    std::array<double, 4> rise{};
};

Weights weights_at(double t) {
    const double u = 1 - t;
    return {{u * u * u / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
             (3 * u * u * u - 6 * u * u + 4) / 6, t * t * t / 6},
            {-u * u / 2, (3 * t * t - 4 * t) / 2, (4 * u - 3 * u * u) / 2, t * t / 2}};
}

/// Wraps a pixel index to the range from 0 to count - 1.
size_t wrapped(int i, int count) {
    const int rest = i % count;
    return static_cast<size_t>(rest < 0 ? rest + count : rest);
}

}  // namespace

ReliefPicture::ReliefPicture(int width, int height, std::vector<float> grey, std::string checksum)
    : width_(width), height_(height), grey_(std::move(grey)), checksum_(std::move(checksum)) {
    constexpr int kTried = 4;
    for (int j = 0; j < kTried * height; ++j) {
        for (int i = 0; i < kTried * width; ++i) {
            const Value v = at(static_cast<double>(i) / kTried, static_cast<double>(j) / kTried);
            steepest_ = std::max(steepest_, std::hypot(v.rise_x, v.rise_y));
        }
    }
}

ReliefPicture::Value ReliefPicture::at(double x, double y) const noexcept {
    // the centre of the first pixel is half a pixel from the corner, and rows run downwards
    double column = std::remainder(x, width_) + width_ / 2.0 - 0.5;
    double row = height_ / 2.0 - std::remainder(y, height_) - 0.5;
    const int i = static_cast<int>(std::floor(column));
    const int j = static_cast<int>(std::floor(row));
    const Weights across = weights_at(column - i);
    const Weights down = weights_at(row - j);
    Value out;
    for (size_t b = 0; b < 4; ++b) {
        const size_t of_row =
            wrapped(j + static_cast<int>(b) - 1, height_) * static_cast<size_t>(width_);
        for (size_t a = 0; a < 4; ++a) {
            const double grey = grey_[of_row + wrapped(i + static_cast<int>(a) - 1, width_)];
            out.height += across.of[a] * down.of[b] * grey;
            out.rise_x += across.rise[a] * down.of[b] * grey;
            out.rise_y -= across.of[a] * down.rise[b] * grey;
        }
    }
    return out;
}

ReliefPicture read_relief(const std::string& file, const Place& place) {
    GreyImage image = read_data(file, ReliefPicture::kFewest, ReliefPicture::kMost, place);
    return {image.width, image.height, std::move(image.grey), std::move(image.checksum)};
}

}  // namespace dihaptic::scene
