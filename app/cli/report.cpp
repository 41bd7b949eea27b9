#include "analysis/report/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/plural.h"
#include "command.h"
#include "common/drawn_report.h"
#include "session/study_session.h"
#include "study_collection.h"

namespace dihaptic::cli {
namespace {

struct ReportOptions {
    std::vector<std::string> paths;
    std::string rehearsed;
    std::string out;
    bool tables = false;  // write only the tables, not the page
};

/// The folder with the sessions of a study's participants. Throws Error when the folder does not
/// exist yet.
std::string sessions_of(const StudyData& data) {
    const std::string folder = study_of(data).data + "/sessions";
    if (!std::filesystem::is_directory(folder))
        throw Error({data.file, 0}, "", "has no session yet",
                    "Run a session, or rehearse the study and add --rehearsed FOLDER.");
    return folder;
}

/// Throws Error when the options contradict each other.
void check_options(const ReportOptions& options) {
    const std::string& first = options.paths.front();
    const bool one = options.paths.size() == 1;
    if (!options.rehearsed.empty() && !(one && is_study(first))) {
        if (one) throw Error({first, 0}, "", "is not a study's file", "Leave out --rehearsed.");
        throw Error({"--rehearsed", 0}, "", "is valid only with a single study",
                    "Leave it out, and give the rehearsal's 'sessions' folder as a path.");
    }
    if (!options.out.empty() && options.tables)
        throw Error(
            {"--out", 0}, "", "is the folder for the page, but with --tables no page is drawn",
            "Leave out one of the two: tables are written to the folders of their sessions.");
    if (!options.out.empty() && one)
        throw Error({"--out", 0}, "", "is valid only with several paths",
                    "Leave it out: the page of one path goes into its folder.");
    if (options.out.empty() && !one && !options.tables)
        throw Error({first, 0}, "", "and the other paths have no common folder for their page",
                    "Name one with --out, or add --tables.");
}

/// Makes the folder for the page. Throws Error when the folder cannot be made.
void make_folder(const std::string& folder) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed)
        throw Error({folder, 0}, "", "cannot be made: " + failed.message(),
                    "Name a folder in which you may write with --out.");
}

/// Writes the tables for all folders, and reports what is wrong with the sessions.
analysis::ReportResult write_tables_of(const std::vector<std::string>& folders) {
    analysis::ReportResult result;
    {
        ProgressLine line("reading");
        double before = 0;
        const auto count = static_cast<double>(folders.size());
        for (const std::string& folder : folders) {
            result.add(analysis::write_tables(
                folder, [&](double share) { line.show_or_stop((before + share) / count); },
                session::counts_in_study));
            ++before;
        }
    }
    print(result.changed);
    print(result.unwritten);
    for (const std::string& why : result.left_out) fmt::print("left out: {}\n", why);
    for (const std::string& what : result.log) fmt::print("raw.log: {}\n", what);
    return result;
}

void report(const ReportOptions& options) {
    check_options(options);
    if (!options.out.empty()) make_folder(options.out);
    std::vector<std::string> folders;
    for (const std::string& path : options.paths)
        folders.push_back(is_study(path) ? sessions_of({path, options.rehearsed}) : path);
    std::optional<app::PageDrawer> drawer;
    if (!options.tables) drawer.emplace(folders, app::PythonSays::on_terminal);
    analysis::ReportResult result = write_tables_of(folders);
    result.out = options.out;
    std::string made;
    if (drawer) {
        drawer->draw(result, command_line());
        made = result.page();
    }
    std::vector<std::string> tables;
    for (const std::string& file : result.tables) {
        const std::string name = std::filesystem::path(file).filename();
        if (std::ranges::find(tables, name) == tables.end()) tables.push_back(name);
    }
    if (!made.empty() && !tables.empty())
        made += options.paths.size() > 1 ? "; in the folder of each path " : ", ";
    made += fmt::format("{}", fmt::join(tables, ", "));
    fmt::print("{}: of {}\n", made.empty() ? "no table" : made,
               counted(result.sessions, "session"));
}

}  // namespace

void add_report(CLI::App& app) {
    auto* command = app.add_subcommand("report",
                                       "Make report.html with its figures, and tables as CSV: for "
                                       "a session, or for all sessions in a folder or of a study");
    auto options = std::make_shared<ReportOptions>();
    command
        ->add_option("SESSION|FOLDER|STUDY", options->paths,
                     "sessions, folders with sessions, or files of studies")
        ->required();
    command->add_option("--rehearsed", options->rehearsed,
                        "with a study: the folder of its rehearsal, in place of its participants");
    command->add_option("--out", options->out,
                        "with several paths: folder for the page of all of them");
    command->add_flag("--tables", options->tables,
                      "write the tables alone, without drawing the page and its figures");
    command->footer(
        "\nThe figures are in the folder figures beside the page: SVG, PDF and PNG, each with its "
        "points\n"
        "as CSV and the Python script that draws it.\n"
        "\nExamples:\n  dihaptic report sessions/2026-11-20_101500_visuomotor-rotation_S07\n"
        "  dihaptic report sessions\n"
        "  dihaptic report rehearsals/grip-and-lift_1 --tables\n"
        "  dihaptic report sessions rehearsals/grip-and-lift_1 --out both\n"
        "  dihaptic report my-study.yaml");
    command->callback([options] { report(*options); });
}

}  // namespace dihaptic::cli
