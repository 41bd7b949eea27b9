#include "scene/materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "base/checksum.h"
#include "base/diagnostics.h"
#include "base/number.h"
#include "base/regular_file.h"

namespace dihaptic::scene {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kLargestMaterials = 10'000'000;  // size limit: thirty bytes per line [bytes]
constexpr const char* kBlanks = " \t\r";

std::string trimmed(std::string_view text) {
    const size_t from = text.find_first_not_of(kBlanks);
    if (from == std::string_view::npos) return "";
    return std::string(text.substr(from, text.find_last_not_of(kBlanks) + 1 - from));
}

/// Returns the rest of the first line that starts with the keyword.
std::string_view line_of(std::string_view text, std::string_view keyword) {
    size_t at = text.find(keyword);
    while (at != std::string_view::npos && at > 0 && text[at - 1] != '\n')
        at = text.find(keyword, at + 1);
    if (at == std::string_view::npos) return "";
    const std::string_view rest = text.substr(at + keyword.size());
    return rest.substr(0, rest.find('\n'));
}

/// Returns 65536 red + 256 green + blue, computed from fractions between 0 and 1.
int32_t rgb_of(const std::array<double, 3>& shares) {
    int32_t out = 0;
    for (const double share : shares)
        out = out << 8 | static_cast<int32_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
    return out;
}

}  // namespace

std::string materials_of(const std::string& file, std::string_view text) {
    std::string name = trimmed(line_of(text, "mtllib "));
    // programs write paths that were valid on the machine on which they ran
    if (const size_t folder = name.find_last_of("/\\"); folder != std::string::npos)
        name.erase(0, folder + 1);
    if (name.empty()) return "";
    const std::string named = (fs::path(file).parent_path() / name).string();
    const std::string own = materials_beside(file);
    return !is_there(named) && is_there(own) ? own : named;
}

std::string materials_beside(const std::string& file) {
    return fs::path(file).replace_extension(".mtl").string();
}

Materials read_materials(const std::string& file) {
    Materials out;
    std::istringstream in;
    try {
        const std::string bytes = read_bytes(file, kLargestMaterials);
        out.checksum = checksum_of(bytes);
        in.str(bytes);
    } catch (const Error&) {
        return out;
    }
    std::string material;
    for (std::string line; std::getline(in, line);) {
        line = trimmed(line);
        if (line.starts_with("newmtl ")) material = trimmed(line.substr(7));
        if (!line.starts_with("Kd ")) continue;
        std::array<double, 3> share{};
        std::istringstream words(line.substr(3));
        const bool read = std::all_of(share.begin(), share.end(), [&](double& to) {
            std::string word;
            words >> word;
            const auto number = finite_number(word);
            to = number.value_or(0);
            return number.has_value();
        });
        if (read) out.colours[material] = rgb_of(share);
    }
    return out;
}

}  // namespace dihaptic::scene
