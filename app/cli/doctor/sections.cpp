#include "cli/doctor/sections.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "base/companion.h"
#include "base/installed.h"
#include "cli/doctor/disk.h"
#include "cli/doctor/graphics.h"
#include "cli/doctor/makers.h"
#include "cli/doctor/parts.h"
#include "cli/doctor/ports.h"
#include "cli/doctor/real_time.h"
#include "cli/doctor/sound.h"
#include "common/package.h"
#include "frame/settings.h"

namespace dihaptic::doctor {
namespace {

constexpr int kPatience = 15;  // time limit of a section [s]

bool may_open(const std::string& file) {
    return access(file.c_str(), R_OK | W_OK) == 0;
}

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

Findings graphics() {
    return {drawing("", may_open), screen(variable), headset("", variable)};
}

}  // namespace

std::vector<Section> sections() {
    std::vector<Section> out{
        {"real time", "real-time",
         [] { return real_time("", rights_now(frame::Settings{}.real_time_priority)); }},
        {"devices", "ports", [] { return ports("", may_open); }}};
    for (const devices::Backend& backend : devices::backends()) {
        if (backend.survey == nullptr) continue;
        out.push_back({"devices", backend.name,
                       [backend] { return of_maker(backend.name, backend.survey()); }});
    }
    out.push_back({"graphics", "graphics", graphics});
    out.push_back({"sound", "sound", [] { return Findings{sound("", may_open)}; }});
    out.push_back({"disk", "disk", disk, {kAnotherDisk}});
    out.push_back({"parts of Dihaptic", "parts", [] {
                       return parts(companion, variable("PATH"), shipped_folder(),
                                    app::python_folder());
                   }});
    return out;
}

Findings look_from_outside(const Section& section) {
    CompanionTask task;
    std::error_code ignored;
    task.program = std::filesystem::read_symlink("/proc/self/exe", ignored).filename().string();
    task.arguments = {"doctor", "--section", section.name};
    // a graphics driver may reserve any amount of address space, so it is not limited
    task.limits = {kPatience, kPatience, std::numeric_limits<uint64_t>::max(), 1 << 30};
    task.what = "the check";
    try {
        const std::string said = run_companion(task, "").value_or("");
        // libraries may have printed text before the last line
        return from_json(said.substr(said.rfind('\n') + 1));
    } catch (const Error& e) {
        return {section.failed(e.problems().front().what)};
    } catch (const std::exception&) {
        return {section.failed("this check failed")};
    }
}

void look_inside(const std::string& name) {
    // this process may be killed at any moment
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
    const std::vector<Section> all = sections();
    const auto section =
        std::find_if(all.begin(), all.end(), [&](const Section& one) { return one.name == name; });
    if (section == all.end()) return;
    Findings found;
    try {
        found = section->look();
    } catch (const std::exception& e) {
        found = {section->failed(e.what())};
    }
    std::fflush(stdout);
    fmt::print("\n{}", to_json(found));
    std::fflush(stdout);
    std::_Exit(0);  // without destructors: drivers may fail when unloaded
}

}  // namespace dihaptic::doctor
