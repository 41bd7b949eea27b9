#include <fmt/format.h>

#include "analysis/recovery.h"
#include "base/plural.h"
#include "base/regular_file.h"
#include "command.h"

namespace dihaptic::cli {

void add_recover(CLI::App& app) {
    auto* command = app.add_subcommand(
        "recover", "Make a session from the remains of a killed, crashed or damaged run");
    auto session = std::make_shared<std::string>();
    command->add_option("SESSION", *session, "folder of a session")->required();
    command->footer("\nExample:\n  dihaptic recover sessions/2026-11-20_101500_lift-block");
    command->callback([session] {
        const auto folder = recording::SessionFolder::open(*session);
        analysis::Recovery recovery;
        {
            ProgressLine line("writing session.nwb");
            recovery =
                analysis::recover_session(folder, [&](double share) { line.show_or_stop(share); });
        }
        print(recovery.warnings);
        const analysis::SessionFigures& figures = recovery.figures;
        fmt::print("{}, {:.3f} s of session; {}\n", counted(figures.frames, "frame"),
                   figures.duration,
                   figures.log.damaged(recovery.info.ticks) ? "the log is incomplete:"
                                                            : "the log is complete");
        for (const std::string& line :
             recording::describe(figures.log, recovery.info.ticks, recovery.info.planned())) {
            fmt::print("  {}\n", line);
        }
        for (const std::string& line : recording::describe_version(figures.log))
            fmt::print("{}\n", line);
        if (figures.log.left_out > 0)
            fmt::print("{}\n", recording::describe_left_out(figures.log.left_out, figures.tick));
        fmt::print("{}\n", figures.convergence.describe());
        fmt::print("written: {}, trials.csv, phases.csv, episodes.csv, events.csv{}\n",
                   folder.nwb(), is_there(folder.file("lifts.csv")) ? ", lifts.csv" : "");
        if (recovery.had_ended)
            fmt::print("(the session already had its files: they were rebuilt)\n");
    });
}

}  // namespace dihaptic::cli
