#include "output_file.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/diagnostics.h"
#include "base/text_file.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;

bool is_in_session(const fs::path& file) {
    std::error_code none;
    const fs::path folder = file.parent_path().empty() ? "." : file.parent_path();
    return fs::exists(folder / "session.yaml", none) || fs::exists(folder / "raw.log", none);
}

}  // namespace

void check_output_file(const std::string& file, const std::string& input, const std::string& what,
                       const std::string& ending) {
    check_output(file, input, what);
    const fs::path out(file);
    std::error_code none;
    if (!fs::exists(out, none)) return;
    if (is_in_session(out) && ending == ".csv")
        throw Error({file, 0}, "", "is a file in a session's folder", "Name another file.");
    if (out.extension() == ending) return;
    throw Error(
        {file, 0}, "",
        fmt::format("exists, and would be replaced, although its name does not end in {}", ending),
        "Name another file, or remove this one first.");
}

}  // namespace dihaptic::cli
