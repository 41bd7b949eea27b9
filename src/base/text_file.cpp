#include "base/text_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "base/diagnostics.h"
#include "base/disk.h"
#include "base/output.h"
#include "base/regular_file.h"
#include "base/text.h"

namespace dihaptic {
namespace {

/// Length of the character that starts at i [bytes]; 0 if the bytes do not form a character, or
/// form a control character that is not allowed in a text file.
size_t character(std::string_view text, size_t i) {
    const auto first = static_cast<unsigned char>(text[i]);
    const bool white = first == '\t' || first == '\n' || first == '\r' || first == '\f';
    if ((first < 0x20 && !white) || first == 0x7f) return 0;
    return utf8_length(text.substr(i));
}

/// Throws Error for the fault at the start of the remaining text.
[[noreturn]] void refuse(std::string_view rest, const Place& place) {
    const auto fault = find_fault(rest.substr(0, 1));
    if (!fault || static_cast<unsigned char>(rest.front()) >= 0x80)
        throw Error(place, "", "this line is not UTF-8 text", "Save the file as UTF-8.");
    throw Error(place, "", "this line " + fault->what,
                "Leave it out. If the file is one of a session's, dihaptic recover mends it.");
}

void check_encoding(const std::string& text, const std::string& file) {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
        throw Error({file, 0}, "", "is UTF-16 text", "Save it as UTF-8.");
    }
    if (text.find('\0') != std::string::npos) {
        throw Error({file, 0}, "", "is not a text file",
                    "Export it as text (CSV for a movement, YAML for the others).");
    }
    int line = 1;
    for (size_t i = 0; i < text.size();) {
        const size_t length = character(text, i);
        if (length == 0) refuse(std::string_view(text).substr(i), {file, line});
        if (text[i] == '\n') ++line;
        i += length;
    }
}

}  // namespace

std::string read_text_file(const std::string& file, int64_t most) {
    std::string text = read_bytes(file, most);
    if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
    check_encoding(text, file);
    return text;
}

void check_output(const std::string& file, const std::string& input, const std::string& what) {
    namespace fs = std::filesystem;
    if (file.empty()) throw Error("the output has no name", "Name a file.");
    std::error_code ignored;
    if (fs::equivalent(file, input, ignored)) {
        throw Error({file, 0}, "", fmt::format("is {} itself", what), "Name another file.");
    }
    check_replaceable(file);
    const fs::path folder = fs::path(file).parent_path();
    if (access(folder.empty() ? "." : folder.c_str(), W_OK) == 0) return;
    throw Error({file, 0}, "", fmt::format("cannot be written: {}", std::strerror(errno)),
                "Name a file in an existing folder that you can write to.");
}

void write_file(const std::string& text, const std::string& file, Keep keep) {
    Output output(file);
    errno = 0;
    std::ofstream out(output.path(), std::ios::binary);
    out << text;
    out.close();
    if (!out) {
        throw Error({file, 0}, "", fmt::format("cannot be written: {}", std::strerror(errno)),
                    "Check the folder's permissions and the disk's space.");
    }
    if (keep == Keep::at_once) sync_to_disk(output.path());
    output.keep();
    if (keep == Keep::in_time) return;
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    sync_to_disk(folder.empty() ? "." : folder.string());
}

std::string shortened(const std::string& text) {
    constexpr size_t kMost = 40;
    if (text.size() <= kMost) return text;
    size_t end = kMost;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return text.substr(0, end) + "...";
}

}  // namespace dihaptic
