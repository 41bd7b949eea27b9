#include "base/image.h"

#include <fmt/format.h>
#include <png.h>

#include "base/checksum.h"
#include "base/diagnostics.h"
#include "base/regular_file.h"
#include "base/text_file.h"

namespace dihaptic {

namespace {

constexpr int64_t kMostPng = 200'000'000;  // [bytes]
constexpr int64_t kMostPixels = 64'000'000;

/// The last chunk of a PNG file is IEND (PNG specification, 11.2.5); without it, pixels may be
/// missing.
void check_whole(const std::string& bytes, const std::string& file) {
    if (!bytes.starts_with("\x89PNG") || bytes.rfind("IEND") != std::string::npos) return;
    throw Error({file, 0}, "", "was cut short: its end is missing",
                "Copy it again, or export it anew.");
}

}  // namespace

void write_png(const Image& image, const std::string& file) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::string bytes(size, '\0');
    if (png_image_write_to_memory(&png, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) == 0)
        throw Error({file, 0}, "", std::string("cannot be written: ") + png.message, "");
    bytes.resize(size);
    write_file(bytes, file);
}

Image read_png(const std::string& file) {
    const std::string bytes = read_bytes(file, kMostPng);
    check_whole(bytes, file);
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    Image image;
    image.checksum = checksum_of(bytes);
    if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) != 0) {
        if (int64_t{png.width} * png.height > kMostPixels) {
            png_image_free(&png);
            throw Error({file, 0}, "", "has more pixels than this program takes",
                        fmt::format("Make it smaller: {} million pixels are the most.",
                                    kMostPixels / 1'000'000));
        }
        png.format = PNG_FORMAT_RGB;
        image.width = static_cast<int>(png.width);
        image.height = static_cast<int>(png.height);
        image.rgb.resize(PNG_IMAGE_SIZE(png));
        if (png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr) != 0) return image;
    }
    throw Error({file, 0}, "", std::string("cannot be read: ") + png.message,
                "It must be a PNG file.");
}

}  // namespace dihaptic
