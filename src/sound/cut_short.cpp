#include "sound/cut_short.h"

#include <fmt/format.h>

#include <cstdint>

namespace dihaptic::sound {
namespace {

/// Reads a little-endian number of `count` bytes; bytes beyond the end of the file count as zero.
uint64_t number(std::string_view bytes, size_t at, size_t count) {
    uint64_t out = 0;
    for (size_t i = count; i-- > 0;) {
        if (at + i < bytes.size()) out = out << 8 | static_cast<unsigned char>(bytes[at + i]);
    }
    return out;
}

/// Checks the length of the chunk that contains the samples (Microsoft, IBM 1991). In RF64 files
/// (EBU Tech 3306), the length is stored in a separate chunk.
std::string cut_wav(std::string_view bytes) {
    constexpr size_t kHead = 8;  // chunk header: name and size
    uint64_t large = 0;
    for (size_t at = 12; at + kHead <= bytes.size();) {
        const std::string_view name = bytes.substr(at, 4);
        uint64_t size = number(bytes, at + 4, 4);
        at += kHead;
        if (name == "ds64") large = number(bytes, at + 8, 8);
        if (name == "data") {
            if (bytes.starts_with("RF64")) size = large;
            const uint64_t left = bytes.size() - at;
            if (size <= left) return "";
            return fmt::format("has {} bytes of samples, but its header states {}", left, size);
        }
        at += size + size % 2;
    }
    return "ends before its samples";
}

/// Checks that the last page of an Ogg stream is marked as the last (RFC 3533).
std::string cut_ogg(std::string_view bytes) {
    constexpr size_t kHead = 27;
    constexpr unsigned kLast = 4;
    const size_t page = bytes.rfind("OggS");
    const size_t segments = number(bytes, page + kHead - 1, 1);
    size_t end = page + kHead + segments;
    for (size_t i = 0; i < segments; ++i) end += number(bytes, page + kHead + i, 1);
    const bool is_last = (number(bytes, page + 5, 1) & kLast) != 0;
    return is_last && page + kHead <= bytes.size() && end <= bytes.size()
               ? ""
               : "ends before its last page";
}

}  // namespace

std::string cut_short(std::string_view bytes) {
    if (bytes.starts_with("RIFF") || bytes.starts_with("RF64")) return cut_wav(bytes);
    if (bytes.starts_with("OggS")) return cut_ogg(bytes);
    return "";
}

}  // namespace dihaptic::sound
