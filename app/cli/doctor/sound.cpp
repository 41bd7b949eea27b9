#include "cli/doctor/sound.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/diagnostics.h"
#include "sound/player.h"

namespace dihaptic::doctor {
namespace fs = std::filesystem;

Finding silence(const std::string& root, const std::string& failure, const MayOpen& may_open) {
    bool any = false;
    bool closed = false;
    std::error_code failed;
    for (fs::directory_iterator i(root + "/dev/snd", failed), end; !failed && i != end;
         i.increment(failed)) {
        if (!i->path().filename().string().starts_with("pcm")) continue;
        any = true;
        closed = closed || !may_open(i->path().string());
    }
    if (!any)
        return {Verdict::note,
                "output",
                failure +
                    ", and Linux does not find a sound card. Sessions run without sounds; with "
                    "sound: { to: file } a rig writes them to a file",
                {}};
    if (closed)
        return {Verdict::lacks,
                "output",
                failure + ", as you may not open the sound card: sessions run without sounds",
                {"sudo usermod -aG audio $USER    # then log in again"}};
    return {Verdict::lacks,
            "output",
            failure + ": sessions run without sounds",
            {"sudo apt install alsa-utils && speaker-test -c 2 -l 1    # gives more details"}};
}

Finding sound(const std::string& root, const MayOpen& may_open) {
    try {
        return {Verdict::ok, "output", sound::try_speakers({}) + " can be opened", {}};
    } catch (const Error& e) {
        std::string why = e.problems().front().what;
        while (why.ends_with('.')) why.pop_back();
        return silence(root, why, may_open);
    }
}

}  // namespace dihaptic::doctor
