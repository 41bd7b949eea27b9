#include "output_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/diagnostics.h"
#include "base/text_file.h"
#include "recording/session.h"

namespace dihaptic::app {
namespace {

namespace fs = std::filesystem;

bool is_in_session(const fs::path& file) {
    std::error_code none;
    const fs::path folder = file.parent_path().empty() ? "." : file.parent_path();
    return fs::exists(folder / "session.yaml", none) || fs::exists(folder / "raw.log", none);
}

/// Whether a picture in a session's folder is one of its frozen inputs, such as a texture.
bool is_input(const fs::path& file) {
    try {
        const auto folder = recording::SessionFolder::open_tables(file.parent_path().string());
        return std::ranges::any_of(folder.read_info().inputs, [&](const auto& input) {
            return input.file == file.filename().string();
        });
    } catch (const Error&) {
        return true;  // an unreadable session may have it as an input
    }
}

/// Whether the file is one that a session consists of, and that nothing may replace.
bool is_of_session(const fs::path& file, const std::string& ending) {
    constexpr std::array kPictures{".png", ".svg", ".pdf", ".mp4"};
    if (!is_in_session(file)) return false;
    return std::ranges::find(kPictures, ending) == kPictures.end() || is_input(fs::absolute(file));
}

}  // namespace

void check_output_file(const std::string& file, const std::string& input, const std::string& what,
                       const std::string& ending) {
    check_output(file, input, what);
    const fs::path out(file);
    std::error_code none;
    if (!fs::exists(out, none)) return;
    if (is_of_session(out, ending))
        throw Error({file, 0}, "", "is a file in a session's folder", "Name another file.");
    if (out.extension() == ending) return;
    throw Error(
        {file, 0}, "",
        fmt::format("exists, and would be replaced, although its name does not end in {}", ending),
        "Name another file, or remove this one first.");
}

}  // namespace dihaptic::app
