#include <fmt/format.h>

#include <filesystem>

#include "command.h"
#include "resume_command.h"
#include "session/resume.h"
#include "summary.h"

namespace dihaptic::cli {
namespace {

struct ResumeOptions {
    std::string session;
    std::string out;
    double sync = 0;  // [s]
};

}  // namespace

void resume_session(const std::string& folder, const std::string& out, double sync) {
    const session::Rest rest = session::rest_of(folder, session::Seat::terminal, {});
    const recording::SessionInfo& info = rest.before;
    print(rest.warnings);
    fmt::print("{}", rest.describe());
    session::RunOptions run;
    run.clock = info.clock == "real" ? session::Clock::real : session::Clock::virtual_clock;
    run.command = command_line();
    run.sync = sync;
    run.participant = info.participant;
    run.in_study = info.in_study;
    const std::string parent = std::filesystem::path(rest.plan.resumes).parent_path().string();
    run.out = !out.empty() ? out : parent.empty() ? "." : parent;
    run_plan(rest.plan, run);
}

void add_resume(CLI::App& app) {
    auto* command = app.add_subcommand(
        "resume", "Continue an interrupted session with trials, at the right trial");
    auto options = std::make_shared<ResumeOptions>();
    command->add_option("SESSION", options->session, "folder of the session")->required();
    command->add_option("--out", options->out,
                        "folder for the new session; default: next to the old one");
    command->add_option("--sync", options->sync, "as in dihaptic run [s]")
        ->check(CLI::Range(0.05, 3600.0));
    command->footer(
        "\nFinished trials stay; the interrupted one is repeated. The new session's\ntrials.csv "
        "contains all trials. The hand is moved by the same source as before: a person "
        "at\ndevices, the file's script, or a simulated person. Trials done by mouse continue in "
        "the window\n(dihaptic gui).\n\nExample:\n  dihaptic resume "
        "sessions/2026-01-31_093000_visuomotor-rotation_S07");
    command->callback([options] { resume_session(options->session, options->out, options->sync); });
}

}  // namespace dihaptic::cli
