#include "cli/doctor/parts.h"

#include <fmt/format.h>

#include <array>

#include "common/on_path.h"

namespace dihaptic::doctor {
namespace {

struct Part {
    const char* program;
    const char* what;
    bool needed;
};

/// Dihaptic's other programs, which `dihaptic` calls.
constexpr std::array kParts{
    Part{"dihaptic-mesh", "reads meshes", true},
    Part{"dihaptic-decompose", "cuts concave meshes", true},
    Part{"dihaptic-host", "owns the real devices, and switches their force off if all else fails",
         false},
    Part{"dihaptic-gui", "shows the operator's window", false},
};

/// Whether Dihaptic was installed from its packages, rather than built in a source folder.
bool is_package(const std::string& shipped) {
    return shipped.starts_with("/usr/");
}

Finding reports(const std::string& python, const std::string& shipped) {
    if (!python.empty())
        return {
            Verdict::ok, "Python", "the package dihaptic draws reports; it is in " + python, {}};
    return {Verdict::lacks,
            "Python",
            "the package dihaptic, which draws the pages and figures of reports, is missing",
            {is_package(shipped) ? "sudo apt install python3-dihaptic"
                                 : "./dev build    # in Dihaptic's own folder"}};
}

Finding films(const std::string& paths) {
    if (!app::found_on(paths, "ffmpeg").empty())
        return {Verdict::ok, "ffmpeg", "makes videos of sessions", {}};
    return {Verdict::lacks,
            "ffmpeg",
            "is missing, which makes videos of sessions",
            {"sudo apt install ffmpeg"}};
}

Finding path(const std::string& paths) {
    if (app::shell_finds_program(paths))
        return {Verdict::ok, "PATH", "your shell finds this program from any folder", {}};
    return {Verdict::note,
            "PATH",
            "your shell does not find this program when you type just 'dihaptic'",
            {app::path_command()}};
}

}  // namespace

Findings parts(const std::function<std::string(const std::string&)>& companion,
               const std::string& paths, const std::string& shipped, const std::string& python) {
    Findings out;
    for (const Part& part : kParts) {
        const std::string name = std::string(part.program).substr(sizeof "dihaptic-" - 1);
        if (companion(part.program).empty()) {
            out.push_back({Verdict::lacks,
                           name,
                           fmt::format("{}, which {}, is missing", part.program, part.what),
                           {is_package(shipped) ? "sudo apt install --reinstall dihaptic"
                                                : "./dev build    # in Dihaptic's own folder"},
                           part.needed});
        } else {
            out.push_back({Verdict::ok, name, fmt::format("{} {}", part.program, part.what), {}});
        }
    }
    out.push_back(reports(python, shipped));
    out.push_back(films(paths));
    out.push_back(path(paths));
    if (shipped.empty()) {
        out.push_back({Verdict::note,
                       "shipped files",
                       "not found: scenes, rigs and experiments to begin with are in Dihaptic's "
                       "own folder",
                       {}});
    } else {
        out.push_back({Verdict::ok,
                       "shipped files",
                       fmt::format("scenes, rigs and experiments are in {}",
                                   shipped == "." ? "this folder" : shipped),
                       {}});
    }
    return out;
}

}  // namespace dihaptic::doctor
