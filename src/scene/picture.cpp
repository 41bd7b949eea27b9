#include "scene/picture.h"

#include <fmt/format.h>

#include <algorithm>

namespace dihaptic::scene {

Image read_picture(const std::string& file, int fewest, int most, const Place& place) {
    Image image;
    try {
        image = read_png(file);
    } catch (const Error& e) {
        throw Error(place, "file",
                    fmt::format("the picture {}: {}", file, e.problems().front().what),
                    "Name a PNG file, relative to this one.");
    }
    const auto [least, greatest] = std::minmax(image.width, image.height);
    if (least < fewest || greatest > most)
        throw Error(
            place, "file",
            fmt::format("the picture {} has {} x {} pixels", file, image.width, image.height),
            fmt::format("Make each edge {} to {}.", fewest, most));
    return image;
}

}  // namespace dihaptic::scene
