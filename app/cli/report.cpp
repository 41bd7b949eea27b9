#include "analysis/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/plural.h"
#include "command.h"

namespace dihaptic::cli {

void add_report(CLI::App& app) {
    auto* command = app.add_subcommand(
        "report",
        "Make report.html, and its tables as CSV: for a session, or for all sessions in a folder");
    auto path = std::make_shared<std::string>();
    command->add_option("SESSION|FOLDER", *path, "a session, or a folder with sessions")
        ->required();
    command->footer(
        "\nExamples:\n  dihaptic report sessions/2026-11-20_101500_visuomotor-rotation_S07\n"
        "  dihaptic report sessions");
    command->callback([path] {
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
