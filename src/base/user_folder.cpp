#include "base/user_folder.h"

#include <cstdlib>

namespace dihaptic {
namespace {

/// Returns one of the user's folders. A relative path in the variable is ignored, as the
/// specification demands.
std::string folder(const char* variable, const char* below_home) {
    if (const char* given = std::getenv(variable); given != nullptr && *given == '/') return given;
    const char* home = std::getenv("HOME");
    return home == nullptr || *home != '/' ? "" : std::string(home) + below_home;
}

}  // namespace

std::string user_config() {
    return folder("XDG_CONFIG_HOME", "/.config");
}

std::string user_data() {
    return folder("XDG_DATA_HOME", "/.local/share");
}

std::string user_cache() {
    return folder("XDG_CACHE_HOME", "/.cache");
}

}  // namespace dihaptic
