#include "base/image.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <memory>
#include <string_view>

#include "base/checksum.h"
#include "base/diagnostics.h"
#include "base/regular_file.h"
#include "base/text_file.h"

namespace dihaptic {

namespace {

constexpr int64_t kMostPng = 200'000'000;  // [bytes]
constexpr int64_t kMostPixels = 64'000'000;

/// Checks that the file is complete. The last chunk of a PNG file is IEND (PNG specification,
/// 11.2.5); without it, pixels may be missing.
void check_whole(const std::string& bytes, const std::string& file) {
    if (!bytes.starts_with("\x89PNG") || bytes.rfind("IEND") != std::string::npos) return;
    throw Error({file, 0}, "", "was cut short: its end is missing",
                "Copy it again, or export it again.");
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

namespace {

Error unreadable(const std::string& file, const std::string& why) {
    return {{file, 0}, "", "cannot be read: " + why, "It must be a PNG file."};
}

void check_pixels(int64_t width, int64_t height, const std::string& file) {
    if (width * height <= kMostPixels) return;
    throw Error({file, 0}, "", "has more pixels than this program accepts",
                fmt::format("Make it smaller: at most {} million pixels are allowed.",
                            kMostPixels / 1'000'000));
}

/// Converts every form of PNG file to rows of red, green, blue and alpha. Uses libpng's low-level
/// interface, which applies no gamma. libpng reports errors by longjmp, so no object between the
/// call and the jump's target may have a destructor.
class PngReader {
  public:
    explicit PngReader(const std::string& bytes) : rest_(bytes) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &fail, &warn);
        info_ = png_create_info_struct(png_);
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    bool begin() {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_set_read_fn(png_, this, &take);
        png_read_info(png_, info_);
        png_set_expand(png_);  // expands palettes, samples of fewer than 8 bits, and tRNS
        png_set_gray_to_rgb(png_);
        png_set_add_alpha(png_, 0xffff, PNG_FILLER_AFTER);
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }
    bool read(png_bytep* rows) {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_read_image(png_, rows);
        png_read_end(png_, nullptr);
        return true;
    }
    size_t width() const { return png_get_image_width(png_, info_); }
    size_t height() const { return png_get_image_height(png_, info_); }
    size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
    size_t sample_bytes() const { return png_get_bit_depth(png_, info_) / 8; }
    const std::string& why() const { return why_; }

  private:
    static void take(png_structp png, png_bytep to, size_t size) {
        auto& rest = static_cast<PngReader*>(png_get_io_ptr(png))->rest_;
        if (size > rest.size()) png_error(png, "its end is missing");
        std::copy_n(rest.begin(), size, to);
        rest.remove_prefix(size);
    }
    [[noreturn]] static void fail(png_structp png, png_const_charp why) {
        static_cast<PngReader*>(png_get_error_ptr(png))->why_ = why;
        png_longjmp(png, 1);
    }
    static void warn(png_structp, png_const_charp) {}

    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::string_view rest_;
    std::string why_;
};

/// Returns a sample of one or two bytes as a fraction of the largest possible value.
float share(const uint8_t* at, size_t bytes) {
    return bytes == 1 ? static_cast<float>(at[0]) / 255
                      : static_cast<float>(at[0] << 8 | at[1]) / 65535;
}

}  // namespace

Image read_png(const std::string& file) {
    const std::string bytes = read_bytes(file, kMostPng);
    check_whole(bytes, file);
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    Image image;
    image.checksum = checksum_of(bytes);
    if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) != 0) {
        const std::unique_ptr<png_image, decltype(&png_image_free)> freed(&png, &png_image_free);
        check_pixels(png.width, png.height, file);
        png.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
        png.format = PNG_FORMAT_RGB;
        image.width = static_cast<int>(png.width);
        image.height = static_cast<int>(png.height);
        image.rgb.resize(PNG_IMAGE_SIZE(png));
        if (png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr) != 0) return image;
    }
    throw unreadable(file, png.message);
}

GreyImage read_grey_png(const std::string& file) {
    const std::string bytes = read_bytes(file, kMostPng);
    check_whole(bytes, file);
    PngReader png(bytes);
    if (!png.begin()) throw unreadable(file, png.why());
    check_pixels(static_cast<int64_t>(png.width()), static_cast<int64_t>(png.height()), file);
    std::vector<uint8_t> samples(png.row_bytes() * png.height());
    std::vector<png_bytep> rows;
    for (size_t y = 0; y < png.height(); ++y) rows.push_back(&samples[y * png.row_bytes()]);
    if (!png.read(rows.data())) throw unreadable(file, png.why());

    GreyImage out{
        static_cast<int>(png.width()), static_cast<int>(png.height()), {}, checksum_of(bytes)};
    out.grey.reserve(png.width() * png.height());
    const size_t size = png.sample_bytes();
    for (size_t i = 0; i < samples.size(); i += 4 * size) {
        const auto sample = [&](size_t k) { return share(&samples[i + k * size], size); };
        if (sample(3) < 1)
            throw Error(
                {file, 0}, "",
                fmt::format("pixel {} of row {} is not opaque", out.grey.size() % png.width() + 1,
                            out.grey.size() / png.width() + 1),
                "Export it without transparency (an alpha channel): its grey levels are "
                "data and cannot be transparent.");
        out.grey.push_back((sample(0) + sample(1) + sample(2)) / 3);
    }
    return out;
}

}  // namespace dihaptic
