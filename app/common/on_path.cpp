#include "common/on_path.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <sstream>

#include "base/shell_word.h"

namespace dihaptic::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "dihaptic";

fs::path program_folder() {
    std::error_code ignored;
    return fs::read_symlink("/proc/self/exe", ignored).parent_path();
}

}  // namespace

std::string found_on(const std::string& paths, const std::string& program) {
    std::istringstream list(paths);
    std::error_code ignored;
    for (std::string folder; std::getline(list, folder, ':');) {
        const fs::path file = fs::path(folder.empty() ? "." : folder) / program;
        if (fs::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0)
            return file.string();
    }
    return "";
}

bool shell_finds_program(const std::string& paths) {
    const std::string found = found_on(paths, kProgram);
    std::error_code failed;
    return !found.empty() && fs::equivalent(found, program_folder() / kProgram, failed);
}

std::string path_command() {
    const std::string folder = program_folder().string();
    const std::string word = shell_word(folder);
    if (word != folder) return fmt::format("export PATH={}:\"$PATH\"", word);
    return fmt::format("export PATH=\"{}:$PATH\"", folder);
}

}  // namespace dihaptic::app
