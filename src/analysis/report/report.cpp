#include "analysis/report/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "analysis/report/population_tables.h"
#include "analysis/report/session_tables.h"
#include "base/regular_file.h"
#include "base/text_file.h"
#include "recording/raw_log.h"
#include "recording/remarks.h"

namespace dihaptic::analysis {
namespace {

namespace fs = std::filesystem;

/// Writes the table, unless it has no rows.
void write(std::vector<std::string>& written, const Table& table, const std::string& file) {
    if (table.rows.empty()) return;
    write_csv(table, file);
    written.push_back(file);
}

/// Writes the tables of one session into the session's folder. Returns the names of the files.
std::vector<std::string> write_tables_of(const FittedSession& session) {
    const SessionTables made = session_tables(session);
    std::vector<std::string> out;
    const auto add = [&](const Table& table, const char* name) {
        write(out, recording::marked(table, session.data.info.moved_by),
              session.data.folder.file(name));
    };
    add(made.adaptation, "adaptation.csv");
    add(made.fits, "fits.csv");
    add(made.blocks, "adaptation-blocks.csv");
    add(made.generalisation, "generalisation.csv");
    add(made.thresholds, "thresholds.csv");
    return out;
}

/// Reads the session's log to its end, because the log may have been damaged since the tables were
/// made, and returns the log's faults. Throws Error when the log cannot be read.
std::vector<std::string> faults_of_log(const SessionData& session,
                                       const std::function<void(double)>& progress) {
    recording::RawLogReader log(session.folder.raw_log());
    session.folder.check_log(session.info, log.head());
    while (log.next() != nullptr) {
        if (progress) progress(log.share());
    }
    const recording::LogHealth& health = log.health();
    std::vector<std::string> out = recording::describe_version(health);
    if (!health.damaged(session.info.ticks)) return out;
    const std::vector<std::string> faults =
        recording::describe(health, session.info.ticks, log.head().planned());
    out.insert(out.end(), faults.begin(), faults.end());
    return out;
}

/// Returns what was written by hand into note.txt, or why it cannot be shown.
std::string note_in(const SessionData& session) {
    const std::string file = session.folder.file("note.txt");
    try {
        if (fs::is_symlink(fs::symlink_status(file)))
            return "not shown: note.txt is a link to another file";
        return is_there(file) ? read_text_file(file) : "";
    } catch (const Error& e) {
        return e.what();
    }
}

/// Returns what the operator noted while the session ran, line by line, or why it cannot be shown.
std::string remarks_in(const SessionData& session) {
    std::string out;
    try {
        for (const recording::Remark& remark : recording::read_remarks(session.folder))
            out += recording::describe(remark) + "\n";
        return out;
    } catch (const Error& e) {
        return e.what();
    }
}

ReportSample sample_of(const Sessions& sessions) {
    const SessionData& first = sessions.front()->data;
    ReportSample out{
        first.info.title, first.info.moved_by, "", "", perturbation_table(first.task), "", {}};
    std::set<std::string> not_measured;
    for (const FittedSession* session : sessions) {
        out.folders.push_back(session->data.folder.path());
        if (!session->data.unmeasured.empty()) not_measured.insert(session->data.not_measured());
    }
    out.not_measured = fmt::format("{}", fmt::join(not_measured, "; "));
    return out;
}

ReportResult report_session(const std::string& path, const std::function<void(double)>& progress) {
    const FittedSession session(SessionData::read(path));
    const SessionData& data = session.data;
    ReportResult result;
    result.paths = {data.folder.path()};
    result.sessions = 1;
    result.changed = data.changed;
    // a rehearsal has no raw.log
    if (is_there(data.folder.raw_log())) result.log = faults_of_log(data, progress);
    result.tables = write_tables_of(session);
    ReportSample& sample = result.samples.emplace_back(sample_of({&session}));
    if (data.info.convergence) sample.contact = data.info.convergence->describe();
    sample.note = note_in(data);
    const std::string remarks = remarks_in(data);
    if (!remarks.empty() && !sample.note.empty() && !sample.note.ends_with('\n'))
        sample.note += '\n';
    sample.note += remarks;
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

/// Reads those sessions in a folder that can be read. Reports why the others are left out.
std::vector<SessionData> read_sessions(ReportResult& result, const std::string& folder,
                                       const std::function<void(double)>& progress) {
    std::vector<SessionData> out;
    const std::vector<std::string> paths = find_sessions(folder);
    for (size_t i = 0; i < paths.size(); ++i) {
        try {
            out.push_back(SessionData::read(paths[i]));
        } catch (const Error& e) {
            result.left_out.push_back(e.problems().front().text());
        }
        progress(static_cast<double>(i + 1) / static_cast<double>(paths.size()));
    }
    return out;
}

/// Removes copies of sessions, sessions that are parts of other sessions, and sessions that were
/// cut short.
void leave_out(ReportResult& result, std::vector<SessionData>& sessions,
               const CountsInStudy& counts) {
    // a session that another session resumes is a part of it
    std::set<std::string> earlier;
    for (const SessionData& session : sessions) {
        if (!session.info.resumes.empty())
            earlier.insert(fs::path(session.info.resumes).filename().string());
    }
    std::map<std::string, std::string> folders;  // indexed by the session's identity
    std::erase_if(sessions, [&](const SessionData& session) {
        const std::string name = fs::path(session.folder.path()).filename().string();
        const std::string& identity = session.info.identity;
        const auto [first, is_new] = folders.emplace(identity, session.folder.path());
        // on the virtual clock, two runs of a session are identical, but neither is a copy
        if (!is_new && !identity.empty() && session.info.clock == "real") {
            result.left_out.push_back(session.folder.path() + ": it is the same session as " +
                                      first->second);
        } else if (earlier.contains(name)) {
            result.left_out.push_back(session.folder.path() + ": another session resumes it");
        } else if (session.stands_in()) {
            result.left_out.push_back(session.folder.path() +
                                      ": a simulated person stood in for the participant");
        } else if (session.is_cut_short() &&
                   !(counts && session.info.in_study &&
                     counts(session.folder.path(), *session.info.in_study))) {
            const bool rehearsed = fs::path(session.folder.path())
                                       .parent_path()
                                       .filename()
                                       .string()
                                       .starts_with("unfinished-");  // as src/session names it
            result.left_out.push_back(session.folder.path() +
                                      ": it ended before its trials were done; " +
                                      (rehearsed ? "the same dihaptic rehearse command repeats it"
                                                 : "dihaptic resume continues it"));
        } else {
            return false;
        }
        return true;
    });
}

/// Fits the sessions, and writes the tables of each session into the session's folder. If a folder
/// cannot be written, as in an archive, the other sessions are still reported.
std::vector<FittedSession> fit_and_write(ReportResult& result, std::vector<SessionData> sessions,
                                         const std::function<void(double)>& progress) {
    std::vector<FittedSession> out;
    for (SessionData& session : sessions) {
        const FittedSession& fitted = out.emplace_back(std::move(session));
        try {
            write_tables_of(fitted);
        } catch (const Error& e) {
            for (Problem problem : e.problems()) {
                problem.severity = Severity::warning;
                result.unwritten.push_back(std::move(problem));
            }
        }
        progress(static_cast<double>(out.size()) / static_cast<double>(sessions.size()));
    }
    return out;
}

ReportResult report_folder(const std::string& folder, const std::function<void(double)>& progress,
                           const CountsInStudy& counts) {
    const auto half = [&](double from) {
        return [&progress, from](double share) {
            if (progress) progress(from + 0.5 * share);
        };
    };
    ReportResult result;
    result.paths = {folder};
    std::vector<SessionData> read = read_sessions(result, folder, half(0));
    leave_out(result, read, counts);
    if (read.empty()) throw none_ended(folder, result.left_out);
    const std::vector<FittedSession> sessions = fit_and_write(result, std::move(read), half(0.5));
    result.sessions = static_cast<int>(sessions.size());
    for (const FittedSession& session : sessions) {
        const std::vector<Problem>& changed = session.data.changed;
        result.changed.insert(result.changed.end(), changed.begin(), changed.end());
    }
    const std::vector<Sessions> samples = samples_of(sessions);
    for (const Sessions& one : samples) result.samples.push_back(sample_of(one));
    const PopulationTables made = population_tables(samples);
    const auto add = [&](const Table& table, const char* name) {
        write(result.tables, table, (fs::path(folder) / name).string());
    };
    add(made.people, "population-people.csv");
    add(made.adaptation, "population-adaptation.csv");
    add(made.lifts, "population-lifts.csv");
    add(made.thresholds, "population-thresholds.csv");
    add(made.measures, "population-measures.csv");
    return result;
}

template <class Item>
void add_all(std::vector<Item>& to, const std::vector<Item>& items) {
    to.insert(to.end(), items.begin(), items.end());
}

}  // namespace

std::string ReportResult::page() const {
    return (fs::path(out.empty() ? paths.front() : out) / "report.html").string();
}

void ReportResult::add(const ReportResult& other) {
    add_all(paths, other.paths);
    add_all(tables, other.tables);
    sessions += other.sessions;
    add_all(left_out, other.left_out);
    add_all(changed, other.changed);
    add_all(unwritten, other.unwritten);
    add_all(log, other.log);
    add_all(samples, other.samples);
}

ReportResult write_tables(const std::string& path, const std::function<void(double)>& progress,
                          const CountsInStudy& counts) {
    std::error_code unreadable;  // report_session() will then report that the path is not a session
    const bool is_folder = fs::is_directory(path, unreadable);
    if (!is_folder || is_there(path + "/session.yaml") || is_there(path + "/raw.log"))
        return report_session(path, progress);
    return report_folder(path, progress, counts);
}

}  // namespace dihaptic::analysis
