#include <fmt/format.h>

#include <filesystem>

#include "analysis/recovery.h"
#include "base/field_reader.h"
#include "base/plural.h"
#include "base/regular_file.h"
#include "command.h"
#include "person/person.h"
#include "recording/raw_log.h"
#include "summary.h"

namespace dihaptic::cli {
namespace {

struct Options {
    std::string session;
    std::string out;
    double sync = 0;  // [s]
};

void resume(const Options& options) {
    const auto folder = recording::SessionFolder::open(options.session);
    Diagnostics ignored;  // recovering says it
    const recording::RawLogReader log(folder.raw_log());
    if (folder.read_info(log.head(), ignored).state == recording::SessionState::running) {
        const analysis::Recovery recovery = analysis::recover_session(folder, {});
        print(recovery.warnings);
    }
    recording::SessionInfo info;
    experiment::Plan plan = experiment::make_rest(options.session, info);
    if (const std::string person = folder.file("person.yaml"); is_there(person)) {
        Diagnostics diagnostics;
        person::Traits traits;
        read_fields(traits, read_yaml(person), diagnostics);
        diagnostics.throw_if_errors();
        person::sit_down(plan, traits);
    }
    fmt::print("goes on with {}: {} done\n", folder.path(),
               counted(static_cast<int64_t>(plan.done.size()), "attempt"));
    experiment::RunOptions run;
    run.clock = info.clock == "real" ? experiment::Clock::real : experiment::Clock::virtual_clock;
    run.command = command_line();
    run.sync = options.sync;
    run.participant = info.participant;
    const std::string parent = std::filesystem::path(folder.path()).parent_path().string();
    run.out = !options.out.empty() ? options.out : parent.empty() ? "." : parent;
    run_plan(plan, run);
}

}  // namespace

void add_resume(CLI::App& app) {
    auto* command = app.add_subcommand(
        "resume", "Go on with a session of trials that was interrupted, at the right trial");
    auto options = std::make_shared<Options>();
    command->add_option("SESSION", options->session, "folder of the session")->required();
    command->add_option("--out", options->out, "folder for the new session; default: beside it");
    command->add_option("--sync", options->sync, "as of dihaptic run [s]")
        ->check(CLI::Range(0.05, 3600.0));
    command->footer(
        "\nFinished trials stay; the one that was interrupted is done again. The new session's\n"
        "trials.csv has all of them.\n"
        "\nExample:\n"
        "  dihaptic resume sessions/2026-01-31_093000_visuomotor-rotation_S07");
    command->callback([options] { resume(*options); });
}

}  // namespace dihaptic::cli
