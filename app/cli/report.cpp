#include "analysis/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "base/child.h"
#include "base/installed.h"
#include "base/plural.h"
#include "command.h"
#include "study_collection.h"

namespace dihaptic::cli {
namespace {

/// The folder with the sessions of a study's participants. Throws Error when there is none yet.
std::string sessions_of(const StudyData& data) {
    const std::string folder = study_of(data).data + "/sessions";
    if (!std::filesystem::is_directory(folder))
        throw Error({data.file, 0}, "", "has no session yet",
                    "Run a session, or rehearse the study and add --rehearsed FOLDER.");
    return folder;
}

/// Draws the figures of what lies at `path`, by the Python package. Throws Error when it cannot.
void draw_figures(const std::string& path) {
    const std::string code = in_or_above_program(
        {"python/dihaptic/facts.json", "lib/python3/dist-packages/dihaptic/facts.json"});
    if (code.empty())
        throw Error({path, 0}, "", "has no figures, because the Python package draws them",
                    "Type sudo apt install python3-dihaptic, and repeat the command.");
    const std::string package = std::filesystem::path(code).parent_path().parent_path();
    std::fflush(stdout);  // before the child's own lines
    // another Python, such as Anaconda's, does not have the package
    const Launch launch{
        "/usr/bin/env",
        {"PYTHONPATH=" + package, "/usr/bin/python3", "-m", "dihaptic.figures", path},
        {Launch::kNothing, Launch::kKept, Launch::kKept},
        Launch::kFreshSignals};
    Child python;
    const int failed = python.start(launch);
    const std::optional<int> status = failed == 0 ? python.wait() : std::nullopt;
    if (status != 0)
        throw Error({path, 0}, "", "has no figures, because Python did not draw them",
                    "The lines above this one name the reason.");
}

}  // namespace

void add_report(CLI::App& app) {
    auto* command = app.add_subcommand("report",
                                       "Make report.html, and its tables as CSV: for a session, or "
                                       "for all sessions in a folder or "
                                       "of a study");
    auto path = std::make_shared<std::string>();
    auto study = std::make_shared<StudyData>();
    command
        ->add_option("SESSION|FOLDER", *path,
                     "a session, a folder with sessions, or a study's file")
        ->required();
    command->add_option("--rehearsed", study->rehearsed,
                        "with a study: the folder of its rehearsal, in place of its participants");
    auto figures = std::make_shared<bool>(false);
    command->add_flag(
        "--figures", *figures,
        "also draw figures for a paper, in the folder figures: SVG, PDF and PNG, each "
        "with its points as CSV and the Python script that draws it");
    command->footer(
        "\nExamples:\n  dihaptic report sessions/2026-11-20_101500_visuomotor-rotation_S07\n"
        "  dihaptic report sessions\n"
        "  dihaptic report rehearsals/grip-and-lift_1 --figures\n"
        "  dihaptic report my-study.yaml");
    command->callback([path, study, figures] {
        study->file = *path;
        if (is_study(*path)) {
            *path = sessions_of(*study);
        } else if (!study->rehearsed.empty()) {
            throw Error({*path, 0}, "", "is not a study's file", "Leave out --rehearsed.");
        }
        analysis::ReportResult result;
        {
            ProgressLine line("reading");
            result = analysis::write_report(*path, command_line(),
                                            [&](double share) { line.show(share); });
        }
        print(result.changed);
        for (const std::string& why : result.left_out) fmt::print("left out: {}\n", why);
        for (const std::string& what : result.log) fmt::print("raw.log: {}\n", what);
        std::string tables;
        for (const std::string& file : result.tables)
            tables += ", " + std::filesystem::path(file).filename().string();
        fmt::print("{}{}: of {}\n", result.page, tables, counted(result.sessions, "session"));
        if (*figures) draw_figures(*path);
    });
}

}  // namespace dihaptic::cli
