#include "base/text_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/diagnostics.h"

namespace dihaptic {
namespace {

constexpr uintmax_t kLargest = 500'000'000;  // bytes: ten minutes of ten fingers at 5 kHz fit

/// Bytes of the UTF-8 character that starts at i; 0 when it is none, or a control character that
/// has no place in a text.
size_t character(const std::string& text, size_t i) {
    const auto byte = [&](size_t j) { return static_cast<unsigned char>(text[j]); };
    const unsigned char first = byte(i);
    if (first < 0x20) return first == '\t' || first == '\n' || first == '\r' || first == '\f';
    if (first < 0x7f) return 1;
    const size_t length = first >= 0xf0 && first < 0xf5 ? 4
                          : first >= 0xe0               ? 3
                          : first >= 0xc2               ? 2
                                                        : 0;
    if (first >= 0xf5 || length == 0 || i + length > text.size()) return 0;
    for (size_t j = 1; j < length; ++j) {
        if ((byte(i + j) & 0xc0) != 0x80) return 0;
    }
    return length;
}

void check_encoding(const std::string& text, const std::string& file) {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
        throw Error({file, 0}, "", "is UTF-16 text", "Save it as UTF-8.");
    }
    int line = 1;
    for (size_t i = 0; i < text.size();) {
        const size_t length = character(text, i);
        if (length == 0) {
            const bool binary = static_cast<unsigned char>(text[i]) < 0x80;
            if (binary) {
                throw Error({file, 0}, "", "is not a text file",
                            "Export it as text (CSV for a movement, YAML for the others).");
            }
            throw Error({file, line}, "", "this line is not UTF-8 text", "Save the file as UTF-8.");
        }
        if (text[i] == '\n') ++line;
        i += length;
    }
}

}  // namespace

std::string read_text_file(const std::string& file) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (fs::is_directory(file, ignored))
        throw Error({file, 0}, "", "is a folder", "Name a file in it.");
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in && errno == EACCES) {
        throw Error({file, 0}, "", "cannot be read: you have no permission to",
                    "Give yourself the permission, e.g. chmod u+r.");
    }
    if (!in) {
        throw Error({file, 0}, "",
                    std::string("cannot be read: ") + std::strerror(errno != 0 ? errno : EIO),
                    "Check the name and the folder.");
    }
    if (const uintmax_t size = fs::file_size(file, ignored); !ignored && size > kLargest) {
        throw Error({file, 0}, "", fmt::format("is {} MB large", size / 1'000'000),
                    "No scene, rig, experiment or movement is: check that it is the right file.");
    }
    std::ostringstream out;
    if (in.peek() != std::ifstream::traits_type::eof()) out << in.rdbuf();
    if (in.bad() || out.fail())
        throw Error({file, 0}, "", "cannot be read", "Check the disk and the permissions.");
    std::string text = out.str();
    if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
    check_encoding(text, file);
    return text;
}

void check_writable(const std::string& file) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored)) {
        throw Error({file, 0}, "", "cannot be written: it is a folder, or no file",
                    "Name another file.");
    }
    const fs::path folder = fs::path(file).parent_path();
    if (access(folder.empty() ? "." : folder.c_str(), W_OK) == 0) return;
    throw Error({file, 0}, "", fmt::format("cannot be written: {}", std::strerror(errno)),
                "Name a file in a folder that is there, and that you may write to.");
}

void write_file(const std::string& text, const std::string& file) {
    namespace fs = std::filesystem;
    const std::string part = fmt::format("{}.{}.part", file, getpid());
    errno = 0;
    std::ofstream out(part, std::ios::binary);
    out << text;
    out.close();
    std::error_code failed;
    if (out) fs::rename(part, file, failed);
    if (out && !failed) return;
    const std::string why = failed ? failed.message() : std::strerror(errno);
    fs::remove(part, failed);
    throw Error({file, 0}, "", "cannot be written: " + why,
                "Check the folder's permissions and the disk's space.");
}

std::string shortened(const std::string& text) {
    constexpr size_t kMost = 40;
    if (text.size() <= kMost) return text;
    size_t end = kMost;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return text.substr(0, end) + "...";
}

}  // namespace dihaptic
