#include "common/on_path.h"

#include <fmt/format.h>

#include <filesystem>
#include <sstream>

namespace dihaptic::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "dihaptic";

fs::path program_folder() {
    std::error_code ignored;
    return fs::read_symlink("/proc/self/exe", ignored).parent_path();
}

}  // namespace

bool shell_finds_program(const std::string& paths) {
    std::istringstream list(paths);
    std::error_code failed;
    for (std::string folder; std::getline(list, folder, ':');) {
        const fs::path found = fs::path(folder.empty() ? "." : folder) / kProgram;
        if (!fs::is_regular_file(found, failed)) continue;
        return fs::equivalent(found, program_folder() / kProgram, failed);
    }
    return false;
}

std::string path_command() {
    return fmt::format("export PATH=\"{}:$PATH\"", program_folder().string());
}

}  // namespace dihaptic::app
