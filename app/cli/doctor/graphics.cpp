#include "cli/doctor/graphics.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "base/diagnostics.h"
#include "view/offscreen.h"
#include "view/scene_view.h"

namespace dihaptic::doctor {
namespace {

namespace fs = std::filesystem;

/// Render files of graphics cards that this user may not open.
std::vector<std::string> closed_cards(const std::string& root, const MayOpen& may_open) {
    std::vector<std::string> out;
    std::error_code failed;
    for (fs::directory_iterator i(root + "/dev/dri", failed), end; !failed && i != end;
         i.increment(failed)) {
        const std::string file = i->path().string();
        if (i->path().filename().string().starts_with("render") && !may_open(file))
            out.push_back(file.substr(root.size()));
    }
    return out;
}

}  // namespace

Finding drawn_by(const std::string& renderer, const std::string& version, const std::string& root,
                 const MayOpen& may_open) {
    const std::string found = fmt::format("{} (OpenGL {})", renderer, version);
    if (!view::is_software(renderer)) return {Verdict::ok, "OpenGL", found, {}};
    const std::vector<std::string> closed = closed_cards(root, may_open);
    if (!closed.empty())
        return {Verdict::lacks,
                "OpenGL",
                fmt::format("{}: in software, since you may not open {}: drawing takes processor "
                            "time from the servo",
                            found, fmt::join(closed, ", ")),
                {"sudo usermod -aG render,video $USER    # then log in again"}};
    return {Verdict::note,
            "OpenGL",
            found +
                ": in software. The window draws in less detail, and takes processor time from the "
                "servo; sessions without a window are not affected",
            {}};
}

Finding drawing(const std::string& root, const MayOpen& may_open) {
    try {
        const view::Offscreen picture(64, 64);
        const auto* version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
        return drawn_by(picture.renderer(), version == nullptr ? "?" : version, root, may_open);
    } catch (const Error& e) {
        return {Verdict::lacks,
                "OpenGL",
                e.problems().front().what + ": no window, no pictures, no videos",
                {"sudo apt install libegl1 libegl-mesa0 libgl1-mesa-dri"}};
    }
}

Finding screen(const Variable& variable) {
    for (const char* name : {"WAYLAND_DISPLAY", "DISPLAY"}) {
        if (const std::string value = variable(name); !value.empty())
            return {
                Verdict::ok, "screen", fmt::format("{} is {}: a window can open", name, value), {}};
    }
    return {Verdict::note,
            "screen",
            "none (neither DISPLAY nor WAYLAND_DISPLAY is set): no window here; sessions, pictures "
            "and videos need none. From another machine: ssh -X",
            {}};
}

Finding headset(const std::string& root, const Variable& variable) {
    constexpr const char* kActive = "/openxr/1/active_runtime.json";
    std::vector<std::string> files;
    if (const std::string named = variable("XR_RUNTIME_JSON"); !named.empty())
        files.push_back(named);
    const std::string config = variable("XDG_CONFIG_HOME");
    files.push_back(config.empty() ? variable("HOME") + "/.config" + kActive : config + kActive);
    for (const char* folder : {"/etc/xdg", "/etc", "/usr/local/share", "/usr/share"})
        files.push_back(std::string(folder) + kActive);
    std::error_code ignored;
    for (const std::string& file : files) {
        if (fs::exists(root + file, ignored))
            return {Verdict::ok, "headset", "an OpenXR runtime is active: " + file, {}};
    }
    return {Verdict::note,
            "headset",
            "no OpenXR runtime is active, which rigs with a headset need: start the headset's own "
            "(Monado, SteamVR), and let it make itself the active one",
            {}};
}

}  // namespace dihaptic::doctor
