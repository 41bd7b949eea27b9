#include "base/allowed_libraries.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "base/node.h"

namespace dihaptic {
namespace {

namespace fs = std::filesystem;

/// The file itself, whatever links lead to it; "" if there is none.
fs::path file_itself(const std::string& path) {
    std::error_code failed;
    const fs::path out = fs::canonical(path, failed);
    return failed ? fs::path() : out;
}

bool is_entry(const Node& item, const fs::path& file) {
    if (item.kind != Node::Kind::scalar || !fs::path(item.scalar).is_absolute()) {
        throw Error(item.place, "", "is not the path of a library, from / on",
                    "Write a line for each, e.g. '- /opt/OpenHaptics/lib/libHD.so'.");
    }
    return file_itself(item.scalar) == file;
}

}  // namespace

std::string allowed_libraries_file() {
    const char* const name = "dihaptic/libraries.yaml";
    if (const char* config = std::getenv("XDG_CONFIG_HOME"); config != nullptr && *config == '/')
        return (fs::path(config) / name).string();
    const char* home = std::getenv("HOME");
    if (home == nullptr || *home != '/') return "";
    return (fs::path(home) / ".config" / name).string();
}

bool is_system_library(const std::string& name) {
    return name.find('/') == std::string::npos;
}

bool is_allowed_library(const std::string& path) {
    const std::string list = allowed_libraries_file();
    const fs::path file = file_itself(path);
    std::error_code ignored;
    if (list.empty() || file.empty() || !fs::exists(list, ignored)) return false;
    const Node allowed = read_yaml(list);
    if (allowed.kind == Node::Kind::null) return false;
    if (allowed.kind != Node::Kind::sequence) {
        throw Error({list, 0}, "", "is not a list of libraries",
                    "Write a line for each, e.g. '- /opt/OpenHaptics/lib/libHD.so'.");
    }
    return std::any_of(allowed.items.begin(), allowed.items.end(),
                       [&](const Node& item) { return is_entry(item, file); });
}

}  // namespace dihaptic
