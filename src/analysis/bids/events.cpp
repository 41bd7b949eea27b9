#include "analysis/bids/events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "analysis/lifts.h"
#include "analysis/measures/measures.h"
#include "analysis/perturbations.h"
#include "analysis/trials.h"
#include "base/figure.h"
#include "base/regular_file.h"

namespace dihaptic::analysis::bids {
namespace {

using Json = nlohmann::ordered_json;

/// Columns of trials.csv that are known before a trial begins: rows of moments in it have them too.
constexpr const char* kAskedFor[] = {"trial_num",          "attempt", "block_num", "block",
                                     "trial_num_in_block", "kind",    "round",     "condition",
                                     "perturbation",       "share",   "procedure"};
constexpr const char* kLift = "lift_";  // prefix of the names of columns of lifts.csv

/// An attempt at a trial in this session, and its row in trials.csv.
struct Attempt {
    double start = 0;  // [s]
    double stop = 0;
    size_t row = 0;
};

/// Attempts of this session alone: trials.csv begins with those of the sessions that it resumes.
std::vector<Attempt> attempts_of(const CsvFile& trials, const recording::SessionFolder& session) {
    double earlier = 0;
    if (const std::string before = session.file("trials-before.csv"); is_there(before)) {
        const CsvFile table(before);
        for (size_t i = 0; i < table.rows(); ++i)
            earlier = std::fmax(earlier, table.number(i, "session_num"));
    }
    std::vector<Attempt> out;
    for (size_t i = 0; i < trials.rows(); ++i) {
        if (trials.number(i, "session_num") <= earlier) continue;
        out.push_back({trials.number(i, "start_time"), trials.number(i, "stop_time"), i});
    }
    return out;
}

/// Columns made from trials.csv and lifts.csv, with their descriptions.
std::vector<Table::Column> columns_for(const CsvFile& trials, const CsvFile* lifts,
                                       const recording::SessionFolder& session) {
    std::map<std::string, Table::Column> known;
    for (const Table::Column& c : trial_columns()) known[c.name] = c;
    std::vector<Table::Column> out;
    for (const char* name : kAskedFor)
        if (trials.has(name)) out.push_back(known[name]);
    // what happened or was measured in a trial: only the trial's own row has it
    std::vector<Table::Column> measured = list_figures(TrialMeasures{}).columns;
    const task::Task task = read_frozen_task(session.file("task.yaml"));
    for (Table::Column& c : measure_columns_of(task)) measured.push_back(std::move(c));
    for (const Table::Column& c : measured)
        if (c.name != "attempt" && trials.has(c.name)) out.push_back(c);
    if (lifts == nullptr) return out;
    for (const Table::Column& c : list_figures(Lift{}).columns) {
        if (c.name == "trial_num" || c.name == "attempt" || !lifts->has(c.name)) continue;
        const bool lift = c.name == "lift";
        out.push_back({lift ? c.name : kLift + c.name,
                       (lift ? "grip and lift: " : "of the grip and lift: ") + c.description,
                       c.unit});
    }
    return out;
}

Json sidecar(const std::vector<Table::Column>& columns, const recording::SessionInfo& info) {
    Json json{{"onset", {{"Description", "from the first tick of the recording"}, {"Units", "s"}}},
              {"duration", {{"Description", "of a trial; n/a: a moment"}, {"Units", "s"}}},
              {"trial_type",
               {{"Description", "what began or happened; outcomes and markers are the task's own"},
                {"Levels",
                 {{"trial", "an attempt at a trial, with what was asked for and what was measured"},
                  {"phase", "value: the state that began"},
                  {"outcome", "value: how the trial ended"},
                  {"message", "value: what the participant was shown"},
                  {"line", "value: what the participant was shown below the message"},
                  {"page", "value: text or picture of the page that was shown"},
                  {"sound", "value: the sound that began"},
                  {"sound ends", "value: the sound that ended"},
                  {"marker", "value: the code that was sent"},
                  {"perturbation", "value: on or off"},
                  {"touch", "value: the finger, and what it touched"},
                  {"release", "value: the finger, and what it let go"},
                  {"lift-off", "value: the object"},
                  {"replaced", "value: the object"},
                  {"limit", "value: the limit of force that was reached"}}}}},
              {"value", {{"Description", "of what happened, as said at trial_type"}}},
              {"moved_by", {{"Description", info.moved_by.describe()}}},
              {"simulated", {{"Description", recording::kMovedByColumns[0].description}}}};
    for (const Table::Column& c : columns) {
        json[c.name]["Description"] = c.description;
        if (!c.unit.empty()) json[c.name]["Units"] = c.unit;
    }
    return json;
}

class EventRows {
  public:
    EventRows(const CsvFile& trials, const CsvFile* lifts, const recording::MovedBy& by,
              const recording::SessionFolder& session)
        : trials_(trials), lifts_(lifts), by_(by), columns_(columns_for(trials, lifts, session)) {
        for (size_t i = 0; lifts != nullptr && i < lifts->rows(); ++i)
            lift_of_[{lifts->text(i, "trial_num"), lifts->text(i, "attempt")}] = i;
    }

    const std::vector<Table::Column>& columns() const { return columns_; }
    Row header() const {
        Row row{"onset", "duration", "trial_type", "value"};
        for (const Table::Column& c : columns_) row.push_back(c.name);
        row.insert(row.end(), {"simulated", "moved_by"});
        return row;
    }
    /// Row of an attempt, with all that is known of it.
    Row trial(const Attempt& attempt) const {
        Row row{trials_.text(attempt.row, "start_time"),
                fmt::format("{:.6g}", attempt.stop - attempt.start), "trial",
                trials_.text(attempt.row, "outcome")};
        const std::string nth = trials_.text(attempt.row, "attempt");
        const auto lift = lift_of_.find(
            {trials_.text(attempt.row, "trial_num"), nth.empty() ? "1" : nth});  // without a task
        for (const Table::Column& c : columns_) {
            const bool of_lift = c.name.starts_with("lift");
            const std::string name = c.name.starts_with(kLift) ? c.name.substr(5) : c.name;
            if (!of_lift) {
                row.push_back(trials_.text(attempt.row, name));
            } else {
                row.push_back(lift == lift_of_.end() ? "" : lifts_->text(lift->second, name));
            }
        }
        return finished(row);
    }
    /// Row of a moment, in an attempt or between attempts.
    Row moment(const std::string& onset, const std::string& what, const std::string& value,
               const std::string& number, const Attempt* attempt) const {
        Row row{onset, "n/a", what, value};
        for (const Table::Column& c : columns_) {
            const bool asked_for = std::find(std::begin(kAskedFor), std::end(kAskedFor), c.name) !=
                                   std::end(kAskedFor);
            if (attempt != nullptr && asked_for) {
                row.push_back(trials_.text(attempt->row, c.name));
            } else {
                row.push_back(c.name == "trial_num" ? number : "");
            }
        }
        return finished(row);
    }

  private:
    Row finished(Row row) const {
        row.insert(row.end(), {by_.simulated(), by_.name()});
        return row;
    }

    const CsvFile& trials_;
    const CsvFile* lifts_;
    const recording::MovedBy& by_;
    std::vector<Table::Column> columns_;
    std::map<std::pair<std::string, std::string>, size_t> lift_of_;
};

}  // namespace

std::optional<Events> events_of(const recording::SessionFolder& session,
                                const recording::SessionInfo& info) {
    if (!is_there(session.file("events.csv"))) return std::nullopt;
    const CsvFile moments(session.file("events.csv"));
    const CsvFile trials(session.file("trials.csv"));
    std::optional<CsvFile> lifts;
    if (is_there(session.file("lifts.csv"))) lifts.emplace(session.file("lifts.csv"));
    const EventRows maker(trials, lifts ? &*lifts : nullptr, info.moved_by, session);
    const std::vector<Attempt> attempts = attempts_of(trials, session);

    std::vector<std::pair<double, Row>> rows;  // by onset [s]
    for (const Attempt& attempt : attempts) rows.emplace_back(attempt.start, maker.trial(attempt));
    for (size_t i = 0; i < moments.rows(); ++i) {
        if (moments.text(i, "event") == "trial") continue;  // the attempt has its own row
        const double time = moments.number(i, "time_s");
        const auto in_it = [&](const Attempt& a) { return a.start <= time && time <= a.stop; };
        const auto found = std::find_if(attempts.begin(), attempts.end(), in_it);
        rows.emplace_back(time, maker.moment(moments.text(i, "time_s"), moments.text(i, "event"),
                                             moments.text(i, "detail"), moments.text(i, "trial"),
                                             found == attempts.end() ? nullptr : &*found));
    }
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Events out{{maker.header()}, sidecar(maker.columns(), info).dump(2) + "\n"};
    for (auto& [time, row] : rows) out.rows.push_back(std::move(row));
    return out;
}

}  // namespace dihaptic::analysis::bids
