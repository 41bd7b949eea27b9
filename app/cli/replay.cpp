#include <fmt/format.h>

#include "base/plural.h"
#include "command.h"
#include "session/replay.h"

namespace dihaptic::cli {

void add_replay(CLI::App& app) {
    auto* command = app.add_subcommand(
        "replay",
        "Re-run a session from its device input: the forces must be identical to the bit");
    auto session = std::make_shared<std::string>();
    command->add_option("SESSION", *session, "folder of a session")->required();
    command->footer("\nExample:\n  dihaptic replay sessions/2026-11-20_101500_lift-block");
    command->callback([session] {
        session::ReplayResult result;
        {
            ProgressLine line("replaying");
            result = session::replay_session(*session, stop_requested,
                                             [&](double share) { line.show(share); });
        }
        print(result.warnings);
        for (const std::string& line : result.version) fmt::print("note: {}\n", line);
        for (const std::string& line : result.log) fmt::print("{}\n", line);
        const std::string ticks = counted(result.ticks, "tick");
        if (result.different_ticks > 0) {
            fmt::print(
                "{} of {} differ, the first at {:.3f} s: the session was recorded by another "
                "version or build ({})\n",
                result.different_ticks, ticks, result.first_difference, result.program);
        } else {
            fmt::print("{}{}, every force and position identical to the bit, in {:.2f} s\n",
                       result.good() ? "" : "the first ", ticks, result.elapsed);
        }
        if (result.interrupted) fmt::print("interrupted: the rest was not compared\n");
        if (result.damaged) {
            fmt::print(
                "the log is damaged: missing parts could not be compared, and a replay requires "
                "every tick from the first one on\n");
        }
        if (!result.good()) exit_code = kFailed;
    });
}

}  // namespace dihaptic::cli
