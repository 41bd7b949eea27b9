#include "analysis/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

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
    command->footer(
        "\nExamples:\n  dihaptic report sessions/2026-11-20_101500_visuomotor-rotation_S07\n"
        "  dihaptic report sessions\n"
        "  dihaptic report my-study.yaml");
    command->callback([path, study] {
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
    });
}

}  // namespace dihaptic::cli
