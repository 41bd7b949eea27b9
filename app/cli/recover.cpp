#include <fmt/format.h>

#include "command.h"
#include "summary.h"

namespace dihaptic::cli {

void add_recover(CLI::App& app) {
    auto* command =
        app.add_subcommand("recover", "Make a session of what a killed or crashed run left behind");
    auto session = std::make_shared<std::string>();
    command->add_option("SESSION", *session, "folder of a session")->required();
    command->footer("\nExample:\n  dihaptic recover sessions/2026-11-20_101500_lift-block");
    command->callback([session] {
        const auto folder = recording::SessionFolder::open(*session);
        recording::SessionInfo info = folder.read_info();
        const bool was_running = info.state == recording::SessionState::running;
        if (was_running) {
            info.state = recording::SessionState::recovered;
            folder.write_info(info);
        }
        const analysis::SessionFigures figures = finish(folder.path());
        fmt::print("{} frames, {:.3f} s of session; {}", figures.frames, figures.duration,
                   figures.complete ? "the log is complete" : "the log ends without its end mark");
        if (figures.damaged_bytes > 0)
            fmt::print(", {} bytes of an unfinished chunk left out", figures.damaged_bytes);
        if (figures.missing > 0) fmt::print(", {} frames missing in between", figures.missing);
        fmt::print("\nwritten: {}, trials.csv, phases.csv, events.csv\n", folder.nwb());
        if (!was_running)
            fmt::print("(the session had ended in order: its files were made anew)\n");
    });
}

}  // namespace dihaptic::cli
