#include "session/unfinished_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <vector>

#include "base/diagnostics.h"
#include "base/regular_file.h"
#include "base/text.h"
#include "base/text_file.h"

namespace dihaptic::session {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMessages = "messages.txt";

std::string folder_of(const std::string& rehearsal, const std::string& id) {
    return fmt::format("{}/{}{}", rehearsal, kUnfinished, id);
}

/// Returns a path to an open folder that stays valid even if another folder later takes its name.
fs::path held(int folder) {
    return fmt::format("/proc/self/fd/{}", folder);
}

/// Whether a file belongs to this user and has no other name (hard link) under which it would
/// change, too.
bool is_own_file(int descriptor) {
    struct stat file {};
    return ::fstat(descriptor, &file) == 0 && S_ISREG(file.st_mode) && file.st_nlink == 1 &&
           file.st_uid == ::geteuid();
}

[[noreturn]] void refuse(const std::string& what, const std::string& why) {
    throw Error({what, 0}, "", why,
                "Check its content, and move it away; nothing in it was changed.");
}

/// Whether a folder is a session of this person that was started by a rehearsal: its name has the
/// form DATE_TIME_EXPERIMENT_PERSON (possibly followed by _2 and so on), and it contains
/// session.yaml, scene.yaml or nothing at all.
bool is_session(const fs::directory_entry& entry, const std::string& id) {
    const std::string name = entry.path().filename().string();
    std::tm when{};
    const char* const rest = strptime(name.c_str(), "%Y-%m-%d_%H%M%S", &when);
    const size_t at = name.rfind("_" + id);
    if (rest == nullptr || *rest != '_' || at == std::string::npos ||
        !fs::is_directory(entry.symlink_status()))
        return false;
    const std::string last = name.substr(at + 1 + id.size());
    const bool whole =
        last.empty() ||
        (last.front() == '_' && last.find_first_not_of("0123456789", 1) == std::string::npos);
    return whole && (fs::is_empty(entry.path()) ||
                     fs::is_regular_file(fs::symlink_status(entry.path() / "session.yaml")) ||
                     fs::is_regular_file(fs::symlink_status(entry.path() / "scene.yaml")));
}

}  // namespace

UnfinishedFolder::UnfinishedFolder(const std::string& rehearsal, const std::string& id)
    : id_(id), done_(rehearsal + "/" + id), path_(folder_of(rehearsal, id)) {
    std::error_code ignored;
    fs::create_directory(path_, ignored);
    folder_ = Descriptor(::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (folder_) return;
    if (errno == ELOOP || errno == ENOTDIR)
        refuse(path_, "is a link or a file, not a folder for a session");
    throw Error({path_, 0}, "", fmt::format("cannot be made: {}", std::strerror(errno)),
                "Check the folder's permissions and the disk's space.");
}

bool UnfinishedFolder::lock() {
    messages_ = Descriptor(::openat(folder_.get(), kMessages,
                                    O_CREAT | O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0644));
    if (!messages_ && errno != ELOOP && errno != ENXIO) {
        throw Error({path_ + "/" + kMessages, 0}, "",
                    fmt::format("cannot be written: {}", std::strerror(errno)),
                    "Check the folder's permissions and the disk's space.");
    }
    if (!messages_ || !is_own_file(messages_.get()))
        refuse(path_ + "/" + kMessages, "is a link, is not a file, or belongs to another user");
    // if the file system does not support locks, waiting is pointless
    return ::flock(messages_.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

std::optional<UnfinishedFolder> UnfinishedFolder::take(const std::string& rehearsal,
                                                       const std::string& id) {
    UnfinishedFolder out(rehearsal, id);
    if (!out.lock()) return std::nullopt;
    for (const auto& entry : fs::directory_iterator(held(out.folder_.get()))) {
        if (entry.path().filename() == kMessages || is_session(entry, id)) continue;
        refuse(out.path_ + "/" + entry.path().filename().string(),
               "is not a session, and was not made by a rehearsal");
    }
    out.remove_sessions();
    [[maybe_unused]] const int emptied = ::ftruncate(out.messages_.get(), 0);
    return out;
}

void UnfinishedFolder::remove_sessions() const {
    std::vector<fs::path> sessions;
    for (const auto& entry : fs::directory_iterator(held(folder_.get()))) {
        if (is_session(entry, id_)) sessions.push_back(entry.path());
    }
    for (const fs::path& session : sessions) fs::remove_all(session);  // does not follow links
}

bool UnfinishedFolder::is_done() const {
    return has_session(done_);
}

bool has_session(const std::string& folder) {
    const fs::file_status there = fs::symlink_status(folder);
    if (!fs::exists(there)) return false;
    if (fs::is_directory(there) && fs::is_regular_file(fs::symlink_status(folder + "/person.yaml")))
        return true;
    refuse(folder, "is in the way: it is not a session of a rehearsed person");
}

void UnfinishedFolder::finish(const std::string& session) const {
    std::error_code failed;
    fs::rename(session, done_, failed);  // the session appears either completely or not at all
    if (!failed) return;
    throw Error({done_, 0}, "", "cannot be made: " + failed.message(),
                fmt::format("The session is complete, in {}: move it there yourself.", session));
}

void UnfinishedFolder::remove() const {
    remove_sessions();
    for (const auto& entry : fs::directory_iterator(held(folder_.get()))) {
        if (entry.path().filename() != kMessages) return;  // files from elsewhere are kept
    }
    ::unlinkat(folder_.get(), kMessages, 0);
    ::rmdir(path_.c_str());
}

std::string messages_of(const std::string& rehearsal, const std::string& id) {
    try {
        return mended(read_text_file(folder_of(rehearsal, id) + "/" + kMessages, 1'000'000));
    } catch (const Error&) {
        return "";
    }
}

}  // namespace dihaptic::session
