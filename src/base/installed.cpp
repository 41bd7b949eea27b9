#include "base/installed.h"
#include "base/user_folder.h"

#include <dlfcn.h>

#include <filesystem>
#include <vector>

namespace dihaptic {
namespace {

namespace fs = std::filesystem;

/// The shared library that contains this function, if there is one, in which case the running
/// program is a different one, such as Python.
fs::path file_of_this() {
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void*>(&file_of_this), &info) == 0) return program;
    // for a program, dli_fname is the name with which it was started, which may be one that only a
    // search of PATH finds
    const fs::path library = fs::canonical(info.dli_fname, ignored);
    return ignored || library.extension() != ".so" ? program : library;
}

/// The folder of a user's files for all studies; "" if the user has no home directory.
fs::path own_folder() {
    const std::string data = user_data();
    return data.empty() ? fs::path() : fs::path(data) / "dihaptic";
}

}  // namespace

std::string in_or_above_program(std::initializer_list<std::string> names) {
    std::vector<fs::path> folders;
    for (fs::path at = file_of_this().parent_path(); at.has_relative_path(); at = at.parent_path())
        folders.push_back(at);
    folders.insert(folders.end(),
                   {"/usr/local", "/usr"});  // because other programs use this library too
    std::error_code ignored;
    for (const fs::path& folder : folders) {
        for (const std::string& name : names) {
            if (fs::is_regular_file(folder / name, ignored)) return (folder / name).string();
        }
    }
    return "";
}

std::string shipped_folder() {
    const std::string file = "scenes/block-on-table.yaml";
    const fs::path found = in_or_above_program({file, "share/dihaptic/" + file});
    return found.parent_path().parent_path().string();
}

std::string kept(const std::string& name) {
    if (name.empty() || fs::path(name).is_absolute()) return "";
    std::error_code ignored;
    for (const fs::path& folder : {own_folder(), fs::path(shipped_folder())}) {
        if (!folder.empty() && fs::exists(folder / name, ignored)) return (folder / name).string();
    }
    return "";
}

std::string given_or_kept(const std::string& name) {
    std::error_code ignored;
    if (fs::exists(name, ignored)) return name;
    const std::string found = kept(name);
    return found.empty() ? name : found;
}

std::string named_in(const std::string& folder, const std::string& name) {
    const fs::path beside = (fs::path(folder) / name).lexically_normal();
    std::error_code ignored;
    if (fs::exists(beside, ignored)) return beside.string();
    fs::path below;
    for (const fs::path& step : fs::path(name).lexically_normal())
        if (step != "..") below /= step;
    const std::string found = kept(below.string());
    return found.empty() ? beside.string() : found;
}

}  // namespace dihaptic
