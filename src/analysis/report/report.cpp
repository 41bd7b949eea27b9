#include "analysis/report/report.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "analysis/report/population_page.h"
#include "analysis/report/session_page.h"
#include "base/regular_file.h"
#include "base/text_file.h"

namespace dihaptic::analysis {
namespace {

namespace fs = std::filesystem;

/// Adds who moved the hand to each row of a session's table.
Table of(const SessionData& session, Table table) {
    return recording::marked(std::move(table), session.info.moved_by);
}

/// Writes the table, unless it has no rows.
void write(ReportResult& result, const Table& table, const std::string& file) {
    if (table.rows.empty()) return;
    write_csv(table, file);
    result.tables.push_back(file);
}

ReportResult report_session(const std::string& path, const std::string& command,
                            const std::function<void(double)>& progress) {
    const SessionData session = SessionData::read(path);
    const SessionPage made = session_page(session, command, progress);
    ReportResult result;
    result.sessions = 1;
    write(result, of(session, made.adaptation), session.folder.file("adaptation.csv"));
    write(result, of(session, made.fits), session.folder.file("fits.csv"));
    write(result, of(session, made.blocks), session.folder.file("adaptation-blocks.csv"));
    write(result, of(session, made.generalisation), session.folder.file("generalisation.csv"));
    write(result, of(session, made.thresholds), session.folder.file("thresholds.csv"));
    result.changed = session.changed;
    result.log = made.log;
    result.page = session.folder.file("report.html");
    write_file(made.page.html(), result.page);
    return result;
}

Error none_ended(const std::string& folder, const std::vector<std::string>& left_out) {
    std::vector<Problem> problems{{Severity::error,
                                   {folder, 0},
                                   "",
                                   "contains no completed sessions",
                                   "Name a session's folder, or a folder that contains sessions."}};
    for (const std::string& why : left_out)
        problems.push_back({Severity::warning, {folder, 0}, "", why, ""});
    return Error(problems);
}

ReportResult report_folder(const std::string& folder, const std::string& command,
                           const std::function<void(double)>& progress) {
    ReportResult result;
    const std::vector<std::string> paths = find_sessions(folder);
    std::vector<SessionData> sessions;
    for (size_t i = 0; i < paths.size(); ++i) {
        try {
            sessions.push_back(SessionData::read(paths[i]));
        } catch (const Error& e) {
            result.left_out.push_back(e.problems().front().text());
        }
        if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(paths.size()));
    }
    // a session that is resumed by another one is part of it
    std::set<std::string> earlier;
    for (const SessionData& session : sessions) {
        if (!session.info.resumes.empty())
            earlier.insert(fs::path(session.info.resumes).filename().string());
    }
    std::map<std::string, std::string> folders;  // by the session's identity
    std::erase_if(sessions, [&](const SessionData& session) {
        const std::string name = fs::path(session.folder.path()).filename().string();
        const std::string& identity = session.info.identity;
        const auto [first, is_new] = folders.emplace(identity, session.folder.path());
        // on the virtual clock, a session that is run twice is identical to the bit, but not a copy
        if (!is_new && !identity.empty() && session.info.clock == "real") {
            result.left_out.push_back(session.folder.path() + ": it is the same session as " +
                                      first->second);
        } else if (earlier.contains(name)) {
            result.left_out.push_back(session.folder.path() + ": another session resumes it");
        } else if (session.is_cut_short()) {
            result.left_out.push_back(
                session.folder.path() +
                ": it ended before its trials were done; dihaptic resume continues it");
        } else {
            return false;
        }
        return true;
    });
    if (sessions.empty()) throw none_ended(folder, result.left_out);
    const PopulationPage made = population_page(sessions, folder, command);
    const auto file = [&](const char* name) { return (fs::path(folder) / name).string(); };
    result.sessions = static_cast<int>(sessions.size());
    for (const SessionData& session : sessions) {
        result.changed.insert(result.changed.end(), session.changed.begin(), session.changed.end());
    }
    write(result, made.people, file("population-people.csv"));
    write(result, made.adaptation, file("population-adaptation.csv"));
    write(result, made.lifts, file("population-lifts.csv"));
    write(result, made.thresholds, file("population-thresholds.csv"));
    write(result, made.measures, file("population-measures.csv"));
    result.page = file("report.html");
    write_file(made.page.html(), result.page);
    return result;
}

}  // namespace

ReportResult write_report(const std::string& path, const std::string& command,
                          const std::function<void(double)>& progress) {
    std::error_code unreadable;  // report_session() then reports that it is not a session
    const bool is_folder = fs::is_directory(path, unreadable);
    if (!is_folder || is_there(path + "/session.yaml") || is_there(path + "/raw.log"))
        return report_session(path, command, progress);
    return report_folder(path, command, progress);
}

}  // namespace dihaptic::analysis
