#include "study_collection.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "base/number.h"
#include "base/plural.h"
#include "base/text_file.h"
#include "common/console.h"
#include "session/study_session.h"
#include "session_tables.h"
#include "task/file/experiment.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;

/// The first columns of each row. To distinguish them from the columns of experiments, their names
/// begin with study_, unless no experiment may use the name anyway.
const std::vector<Table::Column> kFront{
    {"seed", "seed of the session"},
    {"group", "group of the study, or the code that conceals it"},
    {"id", "identifier of the participant"},
    {"study_number", "number of the participant in the group, from 1"},
    {"study_session", "session of the study"},
    {"study_condition", "condition of the session; empty: it has none"},
    {"study_version", "version of the study's files, from 1"}};

/// Joins tables of different experiments, one below the other. A cell is empty if its session's
/// table lacks the column.
class JoinedTable {
  public:
    void add(const std::vector<std::string>& front, const TextTable& table) {
        std::vector<size_t> places;
        for (const Table::Column& column : table.columns) places.push_back(place_of(column));
        for (const auto& cells : table.rows) {
            std::vector<std::string> row(columns_.size());
            for (size_t k = 0; k < cells.size() && k < places.size(); ++k)
                row[places[k]] = cells[k];
            rows_.emplace_back(front, std::move(row));
        }
    }

    TextTable table(const std::string& name) const {
        TextTable out{name, kFront, {}};
        out.columns.insert(out.columns.end(), columns_.begin(), columns_.end());
        for (const auto& [front, row] : rows_) {
            out.rows.push_back(front);
            out.rows.back().insert(out.rows.back().end(), row.begin(), row.end());
            out.rows.back().resize(out.columns.size());
        }
        return out;
    }

  private:
    size_t place_of(const Table::Column& column) {
        if (std::ranges::find(kFront, column.name, &Table::Column::name) != kFront.end()) {
            throw Error({"", 0}, column.name,
                        "is a column that the joined tables take from the study",
                        "Rename the factor, draw, variable or measure with this name.");
        }
        const auto [at, is_new] = places_.emplace(column.name, columns_.size());
        if (is_new) columns_.push_back(column);
        std::string& known = columns_[at->second].description;
        // experiments may use the same name with different meanings
        if (known.find(column.description) == std::string::npos)
            known += (known.empty() ? "" : "; or: ") + column.description;
        return at->second;
    }

    std::vector<Table::Column> columns_;
    std::map<std::string, size_t> places_;
    std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> rows_;
};

std::string group_of(const study::StudyFile& study, const study::Member& member, bool reveal) {
    return reveal ? member.group : study.shown_group(member.group);
}

/// The cells that precede each row of a session's tables.
std::vector<std::string> front_of(const CompleteSession& session, const std::string& group) {
    const auto info = recording::SessionFolder::open_tables(session.folder).read_info();
    const recording::InStudy place = info.in_study.value_or(recording::InStudy{});
    return {info.seed,
            group,
            session.member.id,
            number_text(session.member.number),
            place.session,
            place.condition,
            number_text(place.version)};
}

TextTable participants(const study::StudyFile& study, const study::Roster& roster, bool reveal) {
    TextTable out{"participants.csv",
                  {{"id", "identifier of the participant"},
                   {"group", "group of the study, or the code that conceals it"},
                   {"number", "number of the participant in the group, from 1"},
                   {"age", "age of the participant", "years"},
                   {"sex", "as stated: F, M, O (other) or U (not stated)"},
                   {"handedness", "as stated: right, left or both"}},
                  {}};
    for (const study::FactSpec& fact : study.facts)
        out.columns.push_back({fact.name, "fact that the study asks of every participant"});
    const std::vector<Table::Column> last{
        {"added", "when the participant was added, ISO 8601"},
        {"version", "version of the study's files when the participant was added"},
        {"withdrawn", "when the participant withdrew, ISO 8601; empty if taking part"}};
    out.columns.insert(out.columns.end(), last.begin(), last.end());
    for (const study::Member& m : roster.participants) {
        std::vector<std::string> row{
            m.id, group_of(study, m, reveal), number_text(m.number), m.age, m.sex, m.handedness};
        for (const study::FactSpec& fact : study.facts) row.push_back(m.fact(fact.name));
        row.insert(row.end(), {m.added, number_text(m.version), m.withdrawn});
        out.rows.push_back(std::move(row));
    }
    return out;
}

}  // namespace

bool is_study(const std::string& file) {
    std::error_code unreadable;
    return fs::is_regular_file(file, unreadable) && task::kind_of(file) == task::FileKind::study;
}

study::StudyFile study_of(const StudyData& data) {
    study::StudyFile study = study::read_study(data.file);
    if (data.rehearsed.empty()) return study;
    if (!fs::is_directory(data.rehearsed))
        throw Error({"--rehearsed", 0}, data.rehearsed, "is not a folder",
                    "Name the folder in which the study was rehearsed, or rehearse it first.");
    study.data = data.rehearsed;
    return study;
}

namespace {

/// A recording and all those that it continues, ordered from first to last.
std::vector<std::string> parts_of(const std::string& folder) {
    std::vector<std::string> out{folder};
    for (;;) {
        const auto info = recording::SessionFolder::open_tables(out.front()).read_info();
        if (info.resumes.empty()) return out;
        const fs::path earlier = fs::path(folder).parent_path() / fs::path(info.resumes).filename();
        if (!fs::is_directory(earlier))
            throw Error({out.front(), 0}, "resumes",
                        fmt::format("{}, which is missing", earlier.string()),
                        "Restore that recording: it contains the first part of the session.");
        out.insert(out.begin(), earlier.string());
    }
}

/// Describes, in words, the recordings of people who are not in the list of participants.
std::vector<std::string> strangers(const study::StudyFile& study, const study::Roster& roster) {
    std::vector<std::string> out;
    std::error_code none;
    for (fs::directory_iterator at(study.data + "/sessions", none), end; !none && at != end;
         at.increment(none)) {
        const std::string id = at->path().filename().string();
        const auto found = std::ranges::find(roster.participants, id, &study::Member::id);
        if (at->is_directory() && !id.starts_with('.') && found == roster.participants.end())
            out.push_back(
                fmt::format("left out: {} is not in participants.yaml", at->path().string()));
    }
    std::ranges::sort(out);
    return out;
}

/// Describes a missing session; if the previous session exists, also the requirements that it does
/// not meet.
std::string missing_session(const study::SessionSpec& session, const study::Member& member,
                            const study::Visit* before) {
    std::string out = fmt::format("missing: {} of {}", session.name, member.id);
    if (before == nullptr) return out;
    const auto unmet = study::unmet_needs(session, before->folder);
    if (!unmet.empty()) out += fmt::format(", who may not begin it: {}", fmt::join(unmet, "; "));
    return out;
}

size_t column_of(const TextTable& table, const std::string& name) {
    const auto found = std::ranges::find(table.columns, name, &Table::Column::name);
    return static_cast<size_t>(found - table.columns.begin());
}

/// The tables of a session. The tables of trials contain the rows of all parts of the session; the
/// lifts of earlier parts are added here, if trials.csv contains their attempts. If an interrupted
/// attempt was repeated in a later part, the later attempt is taken.
std::vector<TextTable> tables_of_parts(const CompleteSession& session) {
    std::vector<TextTable> out = tables_of(session.folder);
    if (session.parts.size() < 2) return out;
    const auto trials = std::ranges::find(out, "trials.csv", &TextTable::name);
    if (trials == out.end()) return out;
    const auto attempts_in = [](const TextTable& table) {
        const size_t trial = column_of(table, "trial_num"), attempt = column_of(table, "attempt");
        return [=](const std::vector<std::string>& row) {
            return std::pair(row[trial], row[attempt]);
        };
    };
    std::set<std::pair<std::string, std::string>> attempts;
    for (const auto& row : trials->rows) attempts.insert(attempts_in(*trials)(row));
    std::erase_if(out, [](const TextTable& table) { return table.name == "lifts.csv"; });
    const auto others = static_cast<std::ptrdiff_t>(out.size());
    for (auto part = session.parts.rbegin(); part != session.parts.rend(); ++part) {
        auto lifts = table_of(*part, "lifts.csv");
        if (!lifts) continue;
        const auto attempt_of = attempts_in(*lifts);
        std::erase_if(lifts->rows,
                      [&](const auto& row) { return attempts.erase(attempt_of(row)) == 0; });
        out.insert(out.begin() + others, std::move(*lifts));  // keeps the parts in order
    }
    return out;
}

}  // namespace

StudySessions::StudySessions(const study::StudyFile& study)
    : roster_(study::read_roster(study)), missing_(strangers(study, roster_)) {
    if (roster_.participants.empty() && !missing_.empty())
        throw Error(
            {study.data + "/participants.yaml", 0}, "",
            "names nobody, but there are recordings in " + study.data + "/sessions",
            "Restore the list of participants. Sessions of 'dihaptic run --simulate' are not "
            "included: rehearse the study.");
    for (const study::Member& member : roster_.participants) {
        const auto visits = session::visits_of(study, member);
        const study::Visit* before = nullptr;
        for (size_t i = 0; i < study.sessions.size(); ++i) {
            const study::Visit* const visit = study::counted(study, visits, i);
            if (visit != nullptr) {
                complete_.push_back({member, visit->folder, parts_of(visit->folder)});
            } else if (member.takes_part()) {
                missing_.push_back(missing_session(study.sessions[i], member, before));
            }
            before = visit;
        }
    }
}

std::vector<TextTable> tables_of(const study::StudyFile& study, const StudySessions& sessions,
                                 const StudyData& data) {
    std::map<std::string, JoinedTable> tables;
    ProgressLine line("collecting");
    double done = 0;
    for (const CompleteSession& session : sessions.complete()) {
        const auto front = front_of(session, group_of(study, session.member, data.reveal_groups));
        for (const TextTable& table : tables_of_parts(session))
            tables[table.name].add(front, table);
        line.show_or_stop(++done / static_cast<double>(sessions.complete().size()));
    }
    line.clear();
    std::vector<TextTable> out{participants(study, sessions.roster(), data.reveal_groups)};
    for (const auto& [name, table] : tables) out.push_back(table.table(name));
    return out;
}

void note_revealed(const study::StudyFile& study, const StudyData& data, const std::string& where) {
    if (data.reveal_groups && study.allocation.concealed)
        study::log(study, "reveal groups", "", where);
}

void collect_study(const StudyData& data, const std::string& out) {
    const study::StudyFile study = study_of(data);
    const StudySessions sessions(study);
    const std::vector<TextTable> tables = tables_of(study, sessions, data);
    const std::string folder = out.empty() ? study.data + "/tables" : out;
    note_revealed(study, data, folder);
    fs::create_directories(folder);
    std::string names;
    for (const TextTable& table : tables) {
        write_file(to_csv(table), folder + "/" + table.name);
        names += (names.empty() ? "" : ", ") + table.name;
    }
    for (const std::string& text : sessions.missing()) fmt::print("{}\n", text);
    fmt::print("{} of {} people: in {}: {}\n",
               counted(static_cast<int64_t>(sessions.complete().size()), "session"),
               sessions.roster().participants.size(), folder, names);
}

}  // namespace dihaptic::cli
