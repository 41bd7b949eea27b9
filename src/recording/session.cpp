#include "recording/session.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <cctype>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <optional>

#include "base/checksum.h"
#include "base/disk.h"
#include "base/field_writer.h"
#include "base/number.h"
#include "base/regular_file.h"
#include "base/text_file.h"

namespace dihaptic::recording {
namespace fs = std::filesystem;
namespace {

/// Last line of session.yaml (the end-of-document mark of YAML); a file without this line is
/// incomplete.
constexpr const char* kEnd = "...\n";
/// The remedy for a folder in which no session can be recorded.
constexpr const char* kOtherFolder =
    "Choose another folder, with --out or under File > Where sessions go in the window.";

/// Returns the text of the file, or "" if it cannot be read.
std::string text_of(const std::string& file) {
    try {
        return read_bytes(file, kMostYaml);
    } catch (const Error&) {
        return "";
    }
}

/// Reads as much YAML as possible from a text. The last line or last few lines are left out,
/// because the meaning of an incomplete line may be wrong.
Node first_lines(std::string text) {
    // every attempt parses the remaining lines again
    constexpr int kMostAttempts = 100;
    constexpr size_t kMostRead = 1'000'000;  // bytes
    size_t read = 0;
    for (int i = 0; i < kMostAttempts && read < kMostRead; ++i) {
        const size_t end = text.rfind('\n');
        if (end == std::string::npos) break;
        text.resize(end);
        read += end;
        try {
            return parse_yaml(text, "");
        } catch (const Error&) {
            continue;
        }
    }
    return {};
}

struct ReadablePart {
    Node node = Node::mapping();
    bool given_up = false;  ///< whether so many keys were damaged that the rest was not examined
};

/// Returns the readable part of a damaged session.yaml: all intact keys, and the first lines of the
/// damaged keys.
ReadablePart readable_part(const std::string& text) {
    ReadablePart out;
    const auto take = [&](const Node& part) {
        out.node.entries.insert(out.node.entries.end(), part.entries.begin(), part.entries.end());
    };
    const auto begins_key = [&](size_t at) {
        return std::isalpha(static_cast<unsigned char>(text[at])) != 0;
    };
    constexpr size_t kLongest = 1'000'000;  // longest key [bytes]; the program writes none as long
    constexpr int kMostDamaged = 100;
    int damaged = 0;
    for (size_t from = 0, to = 0; from < text.size(); from = to) {
        do {
            to = std::min(text.find('\n', to), text.size() - 1) + 1;
        } while (to < text.size() && !begins_key(to));
        const std::string key = text.substr(from, to - from);
        try {
            if (key.size() > kLongest) throw Error("is too long", "");
            if (!key.ends_with('\n')) throw Error("is cut off", "");
            take(parse_yaml(key, ""));
        } catch (const Error&) {
            take(first_lines(key));
            out.given_up = ++damaged > kMostDamaged;
            if (out.given_up) break;
        }
    }
    return out;
}

std::string iso(const std::tm& local) {
    const std::string offset = fmt::format("{:%z}", local);  // +hhmm
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}{}:{}", local, offset.substr(0, 3), offset.substr(3));
}

/// Returns the start time stated in the session folder's name; "" if the folder was renamed.
std::string start_by_name(const std::string& path) {
    const std::string name = fs::weakly_canonical(path).filename().string();
    std::tm local{};
    if (strptime(name.c_str(), "%Y-%m-%d_%H%M%S", &local) == nullptr) return "";
    local.tm_isdst = -1;
    if (mktime(&local) == -1) return "";
    return iso(local);
}

}  // namespace

SessionFolder SessionFolder::open_with(const std::string& path, const char* file) {
    std::error_code unreadable;  // ignored: if the file is unreadable, is_there() below fails too
    std::string folder =
        fs::is_regular_file(path, unreadable) ? fs::path(path).parent_path().string() : path;
    while (folder.size() > 1 && folder.ends_with('/')) folder.pop_back();
    SessionFolder session(folder.empty() ? "." : folder);
    if (!is_there(session.file(file))) {
        throw Error({path, 0}, "", fmt::format("is not a session: there is no {}", file),
                    "Give the folder that 'dihaptic run' printed at its end.");
    }
    return session;
}

SessionFolder SessionFolder::open(const std::string& path) {
    return open_with(path, "raw.log");
}

SessionFolder SessionFolder::open_tables(const std::string& path) {
    return open_with(path, "session.yaml");
}

SessionFolder SessionFolder::create(const std::string& parent, const std::string& name) {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    std::string tidy;
    for (const char c : name)
        tidy += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '-';
    const std::string own = fmt::format("{:%Y-%m-%d_%H%M%S}_{}", local, tidy);
    const std::string stem = parent + "/" + own;
    if (parent.empty()) {
        throw Error({"--out", 0}, "", "does not name a folder",
                    "Name one, or omit --out: sessions then go to 'sessions'.");
    }
    constexpr size_t kLongest = 250;  // most file systems allow 255 bytes; "_2" may be appended
    if (own.size() > kLongest) {
        throw Error(
            fmt::format("the name of the session's folder, made of date, experiment and "
                        "participant, would have {} bytes, but at most {} are allowed; a letter "
                        "beyond a to z has two or more",
                        own.size(), kLongest),
            "Shorten --participant, or the experiment file's name.");
    }
    try {
        fs::create_directories(parent);
        // two sessions that start within a second get different names
        for (int n = 1; n < 10000; ++n) {
            const std::string path = n == 1 ? stem : fmt::format("{}_{}", stem, n);
            if (fs::create_directory(path)) return SessionFolder(path);
        }
    } catch (const fs::filesystem_error& e) {
        throw Error({parent, 0}, "", "no session folder can be created here: " + e.code().message(),
                    kOtherFolder);
    }
    throw Error({parent, 0}, "", "too many sessions in this second", kOtherFolder);
}

SessionInfo SessionFolder::read_info() const {
    const std::string name = file("session.yaml");
    const Node root = read_yaml(name);
    SessionInfo info;
    Diagnostics diagnostics(UnknownKeys::are_left_out);
    if (!text_of(name).ends_with(kEnd)) {
        diagnostics.error({name, 0}, "", "is cut off: it does not end with '...'",
                          "Recover the session with 'dihaptic recover'.");
    }
    read_fields(info, root, diagnostics);
    diagnostics.throw_if_errors();
    return info;
}

SessionInfo SessionFolder::read_info(const Setup& setup, Diagnostics& diagnostics) const {
    std::string why;
    std::optional<SessionInfo> whole;
    try {
        whole = read_info();
    } catch (const Error& e) {
        why = e.problems().front().what;
    }
    if (whole) {
        check_log(*whole, setup);
        return *whole;
    }
    SessionInfo info;
    Diagnostics ignored;  // not reported: the file is already known to be damaged
    const ReadablePart part = readable_part(text_of(file("session.yaml")));
    read_fields(info, part.node, ignored);
    static_cast<Setup&>(info) = setup;
    const bool when = !info.started.empty();
    if (!when) info.started = start_by_name(path_);
    std::string lost;
    const auto lose = [&](const char* what, bool is_lost) {
        if (is_lost) lost += (lost.empty() ? "" : ", ") + std::string(what);
    };
    lose("how many ticks it had", info.ticks == 0);
    lose("its start", info.started.empty());
    lose("command", info.command.empty());
    lose("participant", info.participant.id.empty());
    lose("notes", info.notes.empty());
    if (info.started.empty()) info.started = "1970-01-01T00:00:00+00:00";
    diagnostics.warning(
        {file("session.yaml"), 0}, "",
        why + ". It is rebuilt from raw.log" + (when ? "" : " and the folder's name") +
            (part.given_up ? "; it had so many damaged keys that the rest was not read" : "") +
            "; lost: " + lost,
        "Add what you know by hand.");
    return info;
}

void SessionFolder::check_log(const SessionInfo& info, const Setup& setup) const {
    // sessions of earlier versions have no identity
    if (info.identity.empty() || setup.identity.empty() || info.identity == setup.identity) return;
    throw Error({raw_log(), 0}, "",
                "belongs to a different session from the session.yaml next to it",
                "Restore this session's own log, or the session.yaml that belongs to the log.");
}

void SessionFolder::write_info(const SessionInfo& info) const {
    write_file(to_yaml(write_fields(info)) + kEnd, file("session.yaml"), Keep::at_once);
}

void SessionFolder::sync() const {
    std::error_code failed;
    for (fs::directory_iterator i(path_, failed), end; !failed && i != end; i.increment(failed)) {
        if (i->is_regular_file(failed)) sync_to_disk(i->path().string());
    }
    // the folder's name is stored in its parent folder, which may itself have been created just now
    for (fs::path folder = fs::absolute(path_, failed); !folder.empty() && !failed;
         folder = folder.parent_path()) {
        sync_to_disk(folder.string());
        if (folder == folder.root_path()) break;
    }
}

InputFile SessionFolder::input(const std::string& name) const {
    const RegularFile in(file(name));
    std::vector<std::byte> block(1 << 16);
    Checksum sum;
    for (int64_t at = 0; at < in.size();) {
        const size_t read = in.read(at, block);
        if (read == 0) break;
        sum.add(std::span(block).first(read));
        at += static_cast<int64_t>(read);
    }
    return {name, sum.text()};
}

uint64_t SessionFolder::seed_of(const SessionInfo& info) const {
    if (const auto seed = whole_number<uint64_t>(info.seed)) return *seed;
    throw Error({file("session.yaml"), 0}, "seed", "is not a whole number",
                "Restore the old value; raw.log has it in its first lines.");
}

std::vector<Problem> SessionFolder::changed(const std::vector<InputFile>& inputs,
                                            Severity severity) const {
    std::vector<Problem> out;
    for (const InputFile& recorded : inputs) {
        std::string what;
        try {
            if (input(recorded.file).checksum != recorded.checksum)
                what = "has changed since the session was recorded";
        } catch (const Error& e) {
            what = e.problems().front().what;
        }
        if (!what.empty()) {
            out.push_back({severity,
                           {file(recorded.file), 0},
                           "",
                           what,
                           "Restore the recorded version from a backup, or from another session of "
                           "the same experiment."});
        }
    }
    return out;
}

SessionLock::SessionLock(const SessionFolder& folder)
    : descriptor_(::open(folder.raw_log().c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    // if the file system does not support locks, there is nothing to wait for
    if (!descriptor_ || ::flock(descriptor_.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK)
        return;
    throw Error({folder.path(), 0}, "", "is in use: another dihaptic is recording or recovering it",
                "Wait until it has ended, or end it.");
}

std::string iso_now() {
    const auto now = std::chrono::system_clock::now();
    const std::time_t whole = std::chrono::system_clock::to_time_t(now);
    std::tm local{};
    localtime_r(&whole, &local);
    return iso(local);
}

std::string program_version() {
    return "dihaptic " DIHAPTIC_VERSION;
}

}  // namespace dihaptic::recording
