#include "view/image.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <png.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/diagnostics.h"

namespace dihaptic::view {

void write_png(const Image& image, const std::string& file) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    // renamed when whole
    const std::string part = fmt::format("{}.{}", file, getpid());
    errno = 0;
    if (png_image_write_to_file(&png, part.c_str(), 0, image.rgb.data(), 0, nullptr) != 0 &&
        std::rename(part.c_str(), file.c_str()) == 0)
        return;
    const std::string why = errno != 0 ? std::strerror(errno) : png.message;
    unlink(part.c_str());
    throw Error({file, 0}, "", "cannot be written: " + why, "Name another file by -o.");
}

Image read_png(const std::string& file) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    Image image;
    if (png_image_begin_read_from_file(&png, file.c_str()) != 0) {
        png.format = PNG_FORMAT_RGB;
        image.width = static_cast<int>(png.width);
        image.height = static_cast<int>(png.height);
        image.rgb.resize(PNG_IMAGE_SIZE(png));
        if (png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr) != 0) return image;
    }
    throw Error({file, 0}, "", std::string("cannot be read: ") + png.message,
                "It must be a PNG file.");
}

}  // namespace dihaptic::view
