#include "base/allowed_libraries.h"

#include <algorithm>
#include <filesystem>

#include "base/node.h"
#include "base/user_folder.h"

namespace dihaptic {
namespace {

namespace fs = std::filesystem;

/// The path of the file itself, with all links resolved; "" if the file does not exist.
fs::path file_itself(const std::string& path) {
    std::error_code failed;
    const fs::path out = fs::canonical(path, failed);
    return failed ? fs::path() : out;
}

bool is_entry(const Node& item, const fs::path& file) {
    if (item.kind != Node::Kind::scalar || !fs::path(item.scalar).is_absolute()) {
        throw Error(item.place, "", "must be an absolute path, starting with / (~ is not expanded)",
                    "Write one line for each library, e.g. '- /opt/OpenHaptics/lib/libHD.so'.");
    }
    return file_itself(item.scalar) == file;
}

}  // namespace

std::string allowed_libraries_file() {
    const std::string config = user_config();
    return config.empty() ? "" : config + "/dihaptic/libraries.yaml";
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
                    "Write one line for each library, e.g. '- /opt/OpenHaptics/lib/libHD.so'.");
    }
    return std::any_of(allowed.items.begin(), allowed.items.end(),
                       [&](const Node& item) { return is_entry(item, file); });
}

}  // namespace dihaptic
