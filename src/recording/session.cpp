#include "recording/session.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <filesystem>

#include "base/field_writer.h"
#include "base/table.h"

namespace dihaptic::recording {
namespace fs = std::filesystem;

SessionFolder SessionFolder::open(const std::string& path) {
    const fs::path folder =
        fs::is_regular_file(path) ? fs::path(path).parent_path() : fs::path(path);
    SessionFolder session(folder.empty() ? "." : folder.string());
    if (!fs::exists(session.raw_log())) {
        throw Error({path, 0}, "", "is not a session: there is no raw.log",
                    "Give the folder that 'dihaptic run' printed at its end.");
    }
    return session;
}

SessionFolder SessionFolder::create(const std::string& parent, const std::string& name) {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    std::string tidy;
    for (const char c : name)
        tidy += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '-';
    const std::string stem = fmt::format("{}/{:%Y-%m-%d_%H%M%S}_{}", parent, local, tidy);
    try {
        fs::create_directories(parent);
        // two sessions within a second get different names
        for (int n = 1; n < 10000; ++n) {
            const std::string path = n == 1 ? stem : fmt::format("{}_{}", stem, n);
            if (fs::create_directory(path)) return SessionFolder(path);
        }
    } catch (const fs::filesystem_error& e) {
        throw Error({parent, 0}, "", "no session folder can be made here: " + e.code().message(),
                    "Choose another folder with --out.");
    }
    throw Error({parent, 0}, "", "too many sessions of this second",
                "Choose another folder with --out.");
}

SessionInfo SessionFolder::read_info() const {
    SessionInfo info;
    Diagnostics diagnostics;
    read_fields(info, read_yaml(file("session.yaml")), diagnostics);
    diagnostics.throw_if_errors();
    return info;
}

void SessionFolder::write_info(const SessionInfo& info) const {
    write_file(to_yaml(write_fields(info)), file("session.yaml"));
}

std::string iso_now() {
    const auto now = std::chrono::system_clock::now();
    const std::time_t whole = std::chrono::system_clock::to_time_t(now);
    std::tm local{};
    localtime_r(&whole, &local);
    const std::string offset = fmt::format("{:%z}", local);  // +hhmm
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}{}:{}", local, offset.substr(0, 3), offset.substr(3));
}

std::string program_version() {
    return "dihaptic " DIHAPTIC_VERSION;
}

}  // namespace dihaptic::recording
