#include "cli/doctor/disk.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <set>
#include <sstream>
#include <vector>

#include "base/descriptor.h"
#include "base/disk.h"
#include "base/number.h"
#include "cli/doctor/machine.h"
#include "session/readiness.h"

namespace dihaptic::doctor {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSessions = "sessions";
constexpr size_t kWritten = 16'000'000;  // [bytes]
constexpr size_t kFingers = 2;
constexpr double kTick = 1e-3;  // [s]

/// Decodes a path from mountinfo, in which e.g. a space is written as \040.
std::string unescaped(const std::string& text) {
    std::string out;
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\\' && i + 3 < text.size()) {
            out += static_cast<char>(
                whole_number<unsigned>(std::string_view(text).substr(i + 1, 3), 8).value_or('?'));
            i += 3;
        } else {
            out += text[i];
        }
    }
    return out;
}

bool is_in(const std::string& folder, const std::string& mount) {
    if (mount == "/") return true;
    return folder.starts_with(mount) &&
           (folder.size() == mount.size() || folder[mount.size()] == '/');
}

/// Writes and synchronises a file in the folder, and returns the speed [bytes/s]. Throws Error when
/// writing fails.
double write_speed(const std::string& folder) {
    std::string name = folder + "/dihaptic-doctor-XXXXXX";
    const Descriptor file(mkostemp(name.data(), O_CLOEXEC));
    const auto refused = [&] {
        return Error({folder, 0}, "", fmt::format("cannot be written to: {}", std::strerror(errno)),
                     "");
    };
    if (!file) throw refused();
    unlink(name.c_str());  // the file is removed even if something fails from here on
    const std::vector<char> block(1'000'000, 'd');
    const auto began = std::chrono::steady_clock::now();
    for (size_t written = 0; written < kWritten;) {
        // a disk that becomes full accepts only part of a block
        const ssize_t size = write(file.get(), block.data(), block.size());
        if (size <= 0) throw refused();
        written += static_cast<size_t>(size);
    }
    sync_to_disk(file.get(), folder);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    return static_cast<double>(kWritten) / took.count();
}

Finding speed_of(const std::string& folder) {
    try {
        return keeps_up(write_speed(folder), session::bytes_per_hour(kFingers, kTick) / 3600);
    } catch (const Error& e) {
        return {Verdict::lacks,
                "writing",
                fmt::format("{} {}: no session can be recorded here", folder,
                            e.problems().front().what),
                {kAnotherDisk},
                true};
    }
}

}  // namespace

std::string file_system(const std::string& mounts, const std::string& folder) {
    std::istringstream lines(mounts);
    std::string best;
    std::string type;
    for (std::string line; std::getline(lines, line);) {
        const size_t rest = line.find(" - ");
        std::istringstream before(line);
        std::string mount;
        for (int i = 0; i < 5; ++i) before >> mount;
        mount = unescaped(mount);
        // if two file systems are mounted at the same point, the later one is visible
        if (rest == std::string::npos || !is_in(folder, mount) || mount.size() < best.size())
            continue;
        best = mount;
        std::istringstream(line.substr(rest + 3)) >> type;
    }
    return type;
}

Finding kind_of_disk(const std::string& type, System system) {
    static const std::set<std::string> kNetwork{"nfs",  "nfs4", "cifs",       "smb3",  "9p",
                                                "ceph", "afs",  "fuse.sshfs", "lustre"};
    constexpr const char* kWhat = "file system";
    if (kNetwork.contains(type))
        return {Verdict::note,
                kWhat,
                type +
                    ", over the network: other users' traffic affects its speed. Record on a disk "
                    "of this machine, and copy the recordings afterwards",
                {}};
    if (type == "tmpfs" || type == "ramfs")
        return {Verdict::note,
                kWhat,
                type + ", in memory: recordings are lost at the next restart",
                {}};
    if (type == "overlay" && system == System::live)
        return {Verdict::lacks,
                kWhat,
                "of a live system, in memory: recordings are lost when it is switched off",
                {"cd FOLDER    # on a disk of this machine; or write the stick with "
                 "packaging/image/stick, "
                 "which leaves room for sessions on it"}};
    if (type == "overlay" && system == System::container)
        return {Verdict::note,
                kWhat,
                "of the container: recordings are lost when it is removed. Mount a folder of the "
                "host: docker run -v HOST_FOLDER:CONTAINER_FOLDER",
                {}};
    return {Verdict::ok, kWhat, type.empty() ? "of this machine" : type, {}};
}

Finding keeps_up(double speed, double needed) {
    const std::string found = fmt::format(
        "{:.3g} MB per second; a session with two fingers writes {:g}", speed / 1e6, needed / 1e6);
    if (speed > needed) return {Verdict::ok, "writing", found, {}};
    return {Verdict::lacks,
            "writing",
            found + ": the disk falls behind, and memory fills",
            {kAnotherDisk},
            true};
}

Findings disk() {
    std::error_code ignored;
    const std::string folder =
        fs::canonical(fs::is_directory(kSessions, ignored) ? kSessions : ".", ignored).string();
    const session::Finding room = session::disk(folder, session::bytes_per_hour(kFingers, kTick));
    Finding free{room.good ? Verdict::ok : Verdict::lacks, "room", room.found, {}, true};
    if (!room.good)
        free.commands = {"du -sh sessions/* | sort -h | tail    # the largest sessions",
                         kAnotherDisk};
    const std::string type = file_system(text_of("/proc/self/mountinfo"), folder);
    const System system = fs::exists("/run/live/medium", ignored) ? System::live
                          : container("").empty()                 ? System::installed
                                                                  : System::container;
    return {free, speed_of(folder), kind_of_disk(type, system)};
}

}  // namespace dihaptic::doctor
