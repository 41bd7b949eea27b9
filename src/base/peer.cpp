#include "base/peer.h"

#include <fmt/format.h>
#include <pwd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <ctime>
#include <fstream>

#include "base/number.h"
#include "base/text.h"

namespace dihaptic {
namespace {

std::string name_of(uid_t uid) {
    std::array<char, 4096> room{};
    passwd entry{};
    passwd* found = nullptr;
    if (getpwuid_r(uid, &entry, room.data(), room.size(), &found) == 0 && found != nullptr)
        return found->pw_name;
    return number_text(uid);
}

/// The name of the program that the process runs; "" if the process has ended or is hidden.
std::string program_of(pid_t pid) {
    std::string name;
    std::getline(std::ifstream(fmt::format("/proc/{}/comm", pid)), name);
    return mended(name, Lines::one);
}

/// The text ", since TIME" with the time at which the process started; "" if that time is unknown.
std::string begin_of(pid_t pid) {
    struct stat is {};
    if (stat(fmt::format("/proc/{}", pid).c_str(), &is) != 0) return "";
    std::tm local{};
    localtime_r(&is.st_mtime, &local);
    std::array<char, 32> text{};
    const size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M", &local);
    return ", since " + std::string(text.data(), size);
}

}  // namespace

bool Peer::is_trusted() const {
    return uid == geteuid() || uid == 0;
}

std::string Peer::describe() const {
    const std::string program = program_of(pid);
    return fmt::format("{} (process {} of user {}{})", program.empty() ? "a program" : program, pid,
                       name_of(uid), begin_of(pid));
}

std::optional<Peer> peer_of(int socket) {
    ucred who{};
    socklen_t size = sizeof(who);
    if (getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &who, &size) != 0) return std::nullopt;
    return Peer{who.pid, who.uid};
}

}  // namespace dihaptic
