#include "scene/mesh_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "scene/mesh_numbers.h"

namespace dihaptic::scene {
namespace {

/// A binary STL file consists of 80 arbitrary bytes, the number of triangles, and the triangles.
constexpr size_t kCountAt = 80;
constexpr size_t kHead = 84;
constexpr size_t kTriangle = 50;

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Up to position `end`, replaces each line end that is only a carriage return with a line feed.
void end_lines(std::string& bytes, size_t end) {
    for (size_t i = 0; i < end; ++i) {
        if (bytes[i] == '\r' && (i + 1 == bytes.size() || bytes[i + 1] != '\n')) bytes[i] = '\n';
    }
}

/// Blanks out comments, i.e. text after a #, in those lines of an OBJ file that contain numbers.
/// Names may contain a #.
void blank_comments(std::string& text) {
    constexpr std::string_view kOfNumbers = "vflp0123456789+-.";
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view line = std::string_view(text).substr(begin, end - begin);
        const size_t first = line.find_first_not_of(" \t");
        const size_t comment = line.find('#');
        if (comment != std::string_view::npos &&
            kOfNumbers.find(line[first]) != std::string_view::npos)
            std::fill_n(text.begin() + static_cast<std::ptrdiff_t>(begin + comment),
                        line.size() - comment, ' ');
        begin = end + 1;
    }
}

/// The lines of an OFF file that contain more than a comment.
std::string without_comments(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        std::string_view line = text.substr(begin, end - begin);
        line = line.substr(0, line.find('#'));
        if (line.find_first_not_of(" \t\r") != std::string_view::npos) out.append(line) += '\n';
        begin = end + 1;
    }
    return out;
}

/// Position at which the text part of a PLY file ends.
size_t end_of_text(const std::string& bytes) {
    constexpr std::string_view kEnd = "end_header";
    const size_t end = bytes.find(kEnd);
    if (end == std::string::npos || bytes.substr(0, end).find("binary") == std::string::npos)
        return bytes.size();
    const size_t first = bytes.find_first_of("\r\n");
    const bool is_old = bytes[first] == '\r' && bytes[first + 1] != '\n';
    const size_t after = end + kEnd.size();
    if (is_old && after < bytes.size() && bytes[after] == '\r') return after + 1;
    return after;
}

bool is_text_stl(const std::string& bytes) {
    const size_t start = bytes.find_first_not_of(" \t\r\n");
    if (start == std::string::npos || bytes.find('\0') != std::string::npos) return false;
    constexpr std::string_view kSolid = "solid";
    return std::equal(
        kSolid.begin(), kSolid.end(), bytes.begin() + static_cast<int64_t>(start),
        bytes.begin() + static_cast<int64_t>(std::min(bytes.size(), start + kSolid.size())),
        [](char a, char b) { return a == lower(b); });
}

uint32_t count_of(const std::string& bytes) {
    uint32_t out = 0;
    for (size_t i = 4; i-- > 0;) out = out << 8 | static_cast<uint8_t>(bytes[kCountAt + i]);
    return out;
}

void set_count(std::string& bytes, size_t count) {
    for (size_t i = 0; i < 4; ++i) bytes[kCountAt + i] = static_cast<char>(count >> 8 * i & 0xff);
}

/// Handles a binary STL file whose size does not match its number of triangles.
MeshText tidy_binary_stl(std::string bytes) {
    if (bytes.size() < kHead)
        return {bytes, fmt::format("has {} bytes, fewer than an STL file's header", bytes.size())};
    const size_t count = count_of(bytes);
    const size_t room = (bytes.size() - kHead) / kTriangle;
    const size_t spare = (bytes.size() - kHead) % kTriangle;
    if (count > room)
        return {bytes, fmt::format("ends after {} of the {} triangles announced in its header",
                                   room, count)};
    if (count == 0 && room > 0 && spare == 0) {
        set_count(bytes, room);
        return {bytes, ""};
    }
    const size_t end = kHead + count * kTriangle;
    const bool is_padded = bytes.find_first_not_of('\0', end) == std::string::npos;
    if (count == 0 || (spare == 0 && !is_padded))
        return {bytes, fmt::format("announces {} triangles in its header, but {} bytes follow, "
                                   "enough for {}",
                                   count, bytes.size() - kHead, room)};
    bytes.resize(end);
    return {bytes, ""};
}

MeshText with_numbers(std::string text, const std::string& format) {
    MeshNumbers numbers = look_at_numbers(text, format);
    return {std::move(text), std::move(numbers.fault), numbers.from};
}

MeshText tidy_stl(std::string bytes) {
    const bool is_whole =
        bytes.size() >= kHead && bytes.size() == kHead + kTriangle * size_t{count_of(bytes)};
    if (is_whole) return {std::move(bytes), ""};
    std::string text = bytes;
    text.resize(text.find_last_not_of('\0') + 1);
    if (!is_text_stl(text)) return tidy_binary_stl(std::move(bytes));
    end_lines(text, text.size());
    std::transform(text.begin(), text.end(), text.begin(), lower);
    return with_numbers(std::move(text), "stl");
}

}  // namespace

MeshText tidy(std::string bytes, const std::string& format) {
    if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff"))
        return {std::move(bytes), "is UTF-16 text, with 16 bits a letter"};
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.erase(0, 3);
    if (format == "stl") return tidy_stl(std::move(bytes));
    end_lines(bytes, format == "ply" ? end_of_text(bytes) : bytes.size());
    MeshText out = with_numbers(std::move(bytes), format);
    if (format == "obj") blank_comments(out.bytes);
    if (format == "off") out.bytes = without_comments(out.bytes);
    return out;
}

}  // namespace dihaptic::scene
