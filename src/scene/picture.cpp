#include "scene/picture.h"

#include <fmt/format.h>

#include <algorithm>

namespace dihaptic::scene {

namespace {

template <class Image>
Image read(Image (&reader)(const std::string&), const std::string& file, int fewest, int most,
           const Place& place) {
    Image image;
    try {
        image = reader(file);
    } catch (const Error& e) {
        const Problem& why = e.problems().front();
        throw Error(
            place, "file", fmt::format("the picture {}: {}", file, why.what),
            why.what.ends_with("opaque") ? why.remedy : "Name a PNG file, relative to this one.");
    }
    const auto [least, greatest] = std::minmax(image.width, image.height);
    if (least < fewest || greatest > most)
        throw Error(
            place, "file",
            fmt::format("the picture {} has {} x {} pixels", file, image.width, image.height),
            fmt::format("Make each edge {} to {} pixels long.", fewest, most));
    return image;
}

}  // namespace

Image read_picture(const std::string& file, int fewest, int most, const Place& place) {
    return read(read_png, file, fewest, most, place);
}

GreyImage read_data(const std::string& file, int fewest, int most, const Place& place) {
    return read(read_grey_png, file, fewest, most, place);
}

}  // namespace dihaptic::scene
