#include "base/text_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/disk.h"
#include "base/regular_file.h"

namespace dihaptic {
namespace {

constexpr std::string_view kPart = ".part";

/// Length of the UTF-8 character that starts at i [bytes]; 0 if the bytes there are not one, or are
/// a control character that does not belong in a text.
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

std::string read_text_file(const std::string& file, int64_t most) {
    std::string text = read_bytes(file, most);
    if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
    check_encoding(text, file);
    return text;
}

void check_output(const std::string& file, const std::string& input, const std::string& what) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (fs::equivalent(file, input, ignored)) {
        throw Error({file, 0}, "", fmt::format("is {} itself", what), "Name another file.");
    }
    if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored)) {
        throw Error({file, 0}, "", "cannot be written: it is a folder, or no file",
                    "Name another file.");
    }
    const fs::path folder = fs::path(file).parent_path();
    if (access(folder.empty() ? "." : folder.c_str(), W_OK) == 0) return;
    throw Error({file, 0}, "", fmt::format("cannot be written: {}", std::strerror(errno)),
                "Name a file in a folder that is there, and that you may write to.");
}

std::string part_name(const std::string& file) {
    return fmt::format("{}.{}{}", file, getpid(), kPart);
}

void remove_dead_parts(const std::string& file) {
    namespace fs = std::filesystem;
    const fs::path whole(file);
    const std::string start = whole.filename().string() + ".";
    const std::string folder = whole.parent_path().empty() ? "." : whole.parent_path().string();
    std::error_code failed;
    std::vector<fs::path> dead;
    for (fs::directory_iterator i(folder, failed), end; !failed && i != end; i.increment(failed)) {
        const std::string name = i->path().filename().string();
        if (!name.starts_with(start) || !name.ends_with(kPart)) continue;
        const char* const last = name.data() + name.size() - kPart.size();
        int process = 0;
        const auto [rest, status] = std::from_chars(name.data() + start.size(), last, process);
        if (status == std::errc() && rest == last && process > 0 && kill(process, 0) != 0 &&
            errno == ESRCH)
            dead.push_back(i->path());
    }
    for (const fs::path& part : dead) fs::remove_all(part, failed);
}

void write_file(const std::string& text, const std::string& file, Keep keep) {
    namespace fs = std::filesystem;
    const std::string part = part_name(file);
    errno = 0;
    std::ofstream out(part, std::ios::binary);
    out << text;
    out.close();
    if (out && keep == Keep::at_once) sync_to_disk(part);
    std::error_code failed;
    if (out) fs::rename(part, file, failed);
    if (out && !failed) {
        const fs::path folder = fs::path(file).parent_path();
        if (keep == Keep::at_once) sync_to_disk(folder.empty() ? "." : folder.string());
        return;
    }
    const std::string why = failed ? failed.message() : std::strerror(errno);
    fs::remove(part, failed);
    throw Error({file, 0}, "", "cannot be written: " + why,
                "Check the folder's permissions and the disk's space.");
}

std::optional<double> finite_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const char* const last = word.data() + word.size();
    const auto [end, status] = std::from_chars(word.data(), last, value);
    if (status != std::errc() || end != last || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::string shortened(const std::string& text) {
    constexpr size_t kMost = 40;
    if (text.size() <= kMost) return text;
    size_t end = kMost;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return text.substr(0, end) + "...";
}

}  // namespace dihaptic
