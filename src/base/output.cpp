#include "base/output.h"

#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPart = ".part";

Error not_written(const std::string& file, const std::string& why) {
    return Error({file, 0}, "", "cannot be written: " + why,
                 "Check the folder's permissions and the disk's space.");
}

uint32_t nobodys_guess() {
    uint32_t out = 0;
    while (::getrandom(&out, sizeof out, 0) < 0 && errno == EINTR) continue;
    return out;
}

/// Creates a new folder next to `file` that only this user can enter.
std::string make_folder(const std::string& file) {
    for (int tries = 0; tries < 100; ++tries) {
        std::string folder =
            fmt::format("{}.{}-{:08x}{}", file, ::getpid(), nobodys_guess(), kPart);
        if (::mkdir(folder.c_str(), 0700) == 0) return folder;
        if (errno != EEXIST) break;
    }
    throw not_written(file, std::strerror(errno));
}

/// The ID of the process that created a part, taken from the part's name
/// (`file`.PROCESS-RANDOM.part, in versions before 0.3 `file`.PROCESS.part); 0 if `name` is not the
/// name of a part.
int maker_of(std::string_view name, std::string_view file) {
    if (!name.starts_with(file) || !name.ends_with(kPart)) return 0;
    name.remove_prefix(file.size());
    name.remove_suffix(kPart.size());
    if (!name.starts_with('.')) return 0;
    name.remove_prefix(1);
    int process = 0;
    const char* const last = name.data() + name.size();
    const auto [rest, status] = std::from_chars(name.data(), last, process);
    return status == std::errc() && (rest == last || *rest == '-') ? process : 0;
}

bool is_dead(int process) {
    return process > 0 && ::kill(process, 0) != 0 && errno == ESRCH;
}

}  // namespace

void check_replaceable(const std::string& file) {
    struct stat there {};
    if (::lstat(file.c_str(), &there) != 0 || S_ISREG(there.st_mode)) return;
    if (S_ISLNK(there.st_mode)) {
        std::error_code unreadable;
        throw Error({file, 0}, "",
                    fmt::format("cannot be written: it is a link to {}",
                                fs::read_symlink(file, unreadable).string()),
                    "Remove the link, or name its target.");
    }
    throw Error({file, 0}, "",
                S_ISDIR(there.st_mode)
                    ? "cannot be written: it is a folder"
                    : "cannot be written: it is not a file, but a pipe, a socket or a device",
                "Name another file, or move this one away.");
}

Output::Output(const std::string& file) : file_(file) {
    check_replaceable(file);
    folder_ = make_folder(file);
    path_ = folder_ + "/" + fs::path(file).filename().string();
}

Output::~Output() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

void Output::keep() {
    check_replaceable(file_);
    struct stat there {};  // the new file gets the permissions of the old one
    constexpr mode_t kPermissions = 07777;
    if (::lstat(file_.c_str(), &there) == 0 &&
        ::chmod(path_.c_str(), there.st_mode & kPermissions) != 0)
        throw not_written(file_, std::strerror(errno));
    if (::rename(path_.c_str(), file_.c_str()) != 0) throw not_written(file_, std::strerror(errno));
}

void remove_dead_parts(const std::string& file) {
    const fs::path whole(file);
    const std::string own = whole.filename().string();
    const std::string folder = whole.parent_path().empty() ? "." : whole.parent_path().string();
    std::error_code failed;
    std::vector<fs::path> dead;
    for (fs::directory_iterator i(folder, failed), end; !failed && i != end; i.increment(failed)) {
        if (is_dead(maker_of(i->path().filename().string(), own))) dead.push_back(i->path());
    }
    for (const fs::path& part : dead) fs::remove_all(part, failed);
}

void make_folders(const std::string& root, const std::string& below) {
    std::error_code failed;
    fs::create_directories(root, failed);
    fs::path folder(root);
    for (const fs::path& part : fs::path(below)) {
        if (failed) break;
        folder /= part;
        fs::create_directory(folder, failed);
        if (!fs::is_symlink(fs::symlink_status(folder))) continue;
        throw Error({folder.string(), 0}, "",
                    "is a link, and this program does not write through "
                    "links",
                    "Remove the link, or name another folder.");
    }
    if (!failed && fs::is_directory(folder, failed)) return;
    throw Error({folder.string(), 0}, "",
                "cannot be made: " + (failed ? failed.message() : "a file has that name"),
                "Name another folder, or check its permissions.");
}

}  // namespace dihaptic
