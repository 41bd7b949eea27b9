#include <fmt/format.h>

#include <filesystem>

#include "command.h"
#include "session/resume.h"
#include "summary.h"

namespace dihaptic::cli {
namespace {

struct ResumeOptions {
    std::string session;
    std::string out;
    double sync = 0;  // [s]
};

void resume(const ResumeOptions& options) {
    const session::Rest rest = session::rest_of(options.session, session::Seat::terminal, {});
    const recording::SessionInfo& info = rest.before;
    print(rest.warnings);
    fmt::print("{}", rest.describe());
    session::RunOptions run;
    run.clock = info.clock == "real" ? session::Clock::real : session::Clock::virtual_clock;
    run.command = command_line();
    run.sync = options.sync;
    run.participant = info.participant;
    const std::string parent = std::filesystem::path(rest.plan.resumes).parent_path().string();
    run.out = !options.out.empty() ? options.out : parent.empty() ? "." : parent;
    run_plan(rest.plan, run);
}

}  // namespace

void add_resume(CLI::App& app) {
    auto* command = app.add_subcommand(
        "resume", "Continue an interrupted session with trials, at the right trial");
    auto options = std::make_shared<ResumeOptions>();
    command->add_option("SESSION", options->session, "folder of the session")->required();
    command->add_option("--out", options->out, "folder for the new session; default: beside it");
    command->add_option("--sync", options->sync, "as in dihaptic run [s]")
        ->check(CLI::Range(0.05, 3600.0));
    command->footer(
        "\nFinished trials stay; the interrupted one is repeated. The new session's\ntrials.csv "
        "has all of them. The hand has the same mover again: a person at devices, the "
        "file's\nscript, a simulated person. Trials done by mouse continue in the window (dihaptic "
        "gui).\n\nExample:\n  dihaptic resume sessions/2026-01-31_093000_visuomotor-rotation_S07");
    command->callback([options] { resume(*options); });
}

}  // namespace dihaptic::cli
