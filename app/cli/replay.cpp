#include <fmt/format.h>

#include "command.h"
#include "experiment/session_run.h"

namespace dihaptic::cli {

void add_replay(CLI::App& app) {
    auto* command = app.add_subcommand(
        "replay", "Re-run a session's device input: the forces must come out bit for bit");
    auto session = std::make_shared<std::string>();
    command->add_option("SESSION", *session, "folder of a session")->required();
    command->footer("\nExample:\n  dihaptic replay sessions/2026-11-20_101500_lift-block");
    command->callback([session] {
        experiment::ReplayResult result;
        {
            ProgressLine line("replaying");
            result = experiment::replay_session(*session, stop_requested,
                                                [&](double share) { line.show(share); });
        }
        if (result.different_ticks == 0) {
            fmt::print("{} ticks, every force and position identical to the bit, in {:.2f} s\n",
                       result.ticks, result.elapsed);
            return;
        }
        fmt::print(
            "{} of {} ticks differ, the first at {:.3f} s: the session was recorded by another "
            "version or build, "
            "or its files were changed\n",
            result.different_ticks, result.ticks, result.first_difference);
        exit_code = kFailed;
    });
}

}  // namespace dihaptic::cli
