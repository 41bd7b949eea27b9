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
#include "rows/event_row.h"
#include "task/plan/levels.h"
#include "task/plan/trials.h"

namespace dihaptic::analysis::bids {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLift = "lift_";  // prefix of the names of columns of lifts.csv

/// A column of the data set's table, and the source of its cells.
struct Column : Table::Column {
    enum class Of { asked, measured, lift };
    Of of = Of::asked;
    size_t from = 0;  ///< position in trials.csv or lifts.csv
};

/// An attempt at a trial in this session, and its row in trials.csv.
struct Attempt {
    double start = 0;  // [s]
    double stop = 0;
    size_t row = 0;
};

/// Attempts of this session alone: trials.csv starts with the attempts of the sessions that it
/// resumes.
std::vector<Attempt> attempts_of(const rows::TrialFile& trials,
                                 const recording::SessionFolder& session) {
    const int earlier = sessions_before(session);
    std::vector<Attempt> out;
    for (size_t i = 0; i < trials.size(); ++i) {
        const rows::TrialHead& head = trials[i].head;
        if (head.session > earlier) out.push_back({head.start, head.end, i});
    }
    return out;
}

/// Columns made from trials.csv and lifts.csv, with their descriptions.
std::vector<Column> columns_for(const rows::TrialFile& trials, const rows::LiftFile* lifts,
                                const recording::SessionFolder& session,
                                const recording::SessionInfo& info) {
    std::vector<Column> out;
    const auto add = [&](const Table::Column& column, Column::Of of) {
        if (const auto from = trials.column(column.name)) out.push_back({column, of, *from});
    };
    // rows of moments in a trial also have the data known before its start
    std::vector<Table::Column> asked = list_figures(rows::AskedRow{}).columns;
    std::vector<Table::Column> measured = list_figures(rows::TrialMeasures{}).columns;
    asked.insert(asked.begin() + 1, measured.front());  // the attempt's number
    measured.erase(measured.begin());
    const task::Task task = read_frozen_task(session.file("task.yaml"));
    for (const Table::Column& c : asked) add(c, Column::Of::asked);
    for (const Table::Column& c : task::own_columns(task)) add(c, Column::Of::asked);
    for (const NumberColumn& c : columns_of_numbers(info))
        add(c, c.known_before ? Column::Of::asked : Column::Of::measured);
    // events and measures of a trial: only the trial's own row has them
    for (Table::Column& c : measure_columns_of(task)) measured.push_back(std::move(c));
    for (const Table::Column& c : measured) add(c, Column::Of::measured);
    if (lifts == nullptr) return out;
    const std::vector<Table::Column> of_lifts = list_figures(rows::LiftRow{}).columns;
    for (size_t i = 2; i < of_lifts.size(); ++i) {  // after the numbers of trial and attempt
        const auto from = lifts->column(of_lifts[i].name);
        if (!from) continue;
        const bool mark = i == 2;
        out.push_back(
            {{mark ? of_lifts[i].name : kLift + of_lifts[i].name,
              (mark ? "grip and lift: " : "of the grip and lift: ") + of_lifts[i].description,
              of_lifts[i].unit},
             Column::Of::lift,
             *from});
    }
    return out;
}

/// Describes the columns of answers by their questions, and the numbers of Likert scales by their
/// labels.
void describe_answers(const task::Task& task, Json& json) {
    for (const task::AskSpec& ask : task::questions_of(task)) {
        if (!json.contains(ask.name)) continue;
        if (!ask.question.empty()) json[ask.name]["Description"] = ask.question;
        if (ask.scale != task::Scale::likert) continue;
        for (size_t i = 0; i < ask.labels.size(); ++i) {
            const double number = ask.least() + static_cast<double>(i);
            json[ask.name]["Levels"][fmt::format("{:g}", number)] = ask.labels[i];
        }
    }
}

Json sidecar(const std::vector<Column>& columns, const recording::SessionInfo& info) {
    Json json{
        {"onset", {{"Description", "time from the first tick of the recording"}, {"Units", "s"}}},
        {"duration", {{"Description", "duration of a trial; n/a: a moment"}, {"Units", "s"}}},
        {"trial_type",
         {{"Description", "kind of event; outcomes and markers are the task's own"},
          {"Levels",
           {{"trial", "an attempt at a trial, with its demands and measures"},
            {"phase", "value: the state that began"},
            {"outcome", "value: how the trial ended"},
            {"answer", "value: the answer's column and number, and its form with the version"},
            {"message", "value: message shown to the participant"},
            {"line", "value: line shown to the participant below the message"},
            {"page", "value: text or picture of the page shown"},
            {"sound", "value: the sound that began"},
            {"sound ends", "value: the sound that ended"},
            {"marker", "value: the code sent"},
            {"perturbation", "value: on or off"},
            {"touch", "value: the finger, and the object touched"},
            {"release", "value: the finger, and the object released"},
            {"lift-off", "value: the object"},
            {"replaced", "value: the object"},
            {"limit", "value: the limit of force that was reached"}}}}},
        {"value", {{"Description", "value of the event, as described under trial_type"}}},
        {"moved_by", {{"Description", info.moved_by.describe()}}},
        {"simulated", {{"Description", recording::kMovedByColumns[0].description}}}};
    for (const Column& c : columns) {
        json[c.name]["Description"] = c.description;
        if (!c.unit.empty()) json[c.name]["Units"] = c.unit;
    }
    return json;
}

class EventRows {
  public:
    EventRows(const rows::TrialFile& trials, const rows::LiftFile* lifts,
              const recording::SessionInfo& info, const recording::SessionFolder& session)
        : trials_(trials),
          lifts_(lifts),
          by_(info.moved_by),
          columns_(columns_for(trials, lifts, session, info)) {
        for (size_t i = 0; lifts != nullptr && i < lifts->size(); ++i)
            lift_of_[{(*lifts)[i].trial, (*lifts)[i].attempt}] = i;
    }

    const std::vector<Column>& columns() const { return columns_; }
    Row header() const {
        Row row{"onset", "duration", "trial_type", "value"};
        for (const Column& c : columns_) row.push_back(c.name);
        row.insert(row.end(), {"simulated", "moved_by"});
        return row;
    }
    /// Row of an attempt, with all its data.
    Row trial(const Attempt& attempt) const {
        const rows::TrialRow& of = trials_[attempt.row];
        Row row{number_text(of.head.start), fmt::format("{:.6g}", attempt.stop - attempt.start),
                "trial", of.measures.outcome};
        // without a task, lifts are counted in each trial
        const auto lift = lift_of_.find({of.asked.trial, std::max(of.measures.attempt, 1)});
        for (const Column& c : columns_) {
            if (c.of != Column::Of::lift) {
                row.push_back(trials_.text(attempt.row, c.from));
            } else {
                row.push_back(lift == lift_of_.end() ? "" : lifts_->text(lift->second, c.from));
            }
        }
        return finished(row);
    }
    /// Row of a moment, in an attempt or between attempts.
    Row moment(const rows::EventRow& event, const Attempt* attempt) const {
        Row row{number_text(event.time), "n/a", event.name, event.detail};
        for (const Column& c : columns_) {
            if (attempt != nullptr && c.of == Column::Of::asked) {
                row.push_back(trials_.text(attempt->row, c.from));
            } else {
                row.push_back(&c == &columns_.front() ? number_text(event.trial) : "");
            }
        }
        return finished(row);
    }

  private:
    Row finished(Row row) const {
        row.insert(row.end(), {by_.simulated(), by_.name()});
        return row;
    }

    const rows::TrialFile& trials_;
    const rows::LiftFile* lifts_;
    const recording::MovedBy& by_;
    std::vector<Column> columns_;  // the first holds the trial number
    std::map<std::pair<int, int>, size_t> lift_of_;
};

}  // namespace

std::optional<Events> events_of(const recording::SessionFolder& session,
                                const recording::SessionInfo& info) {
    if (!is_there(session.file("events.csv"))) return std::nullopt;
    const rows::EventFile moments(session.file("events.csv"));
    const rows::TrialFile trials(session.file("trials.csv"));
    std::optional<rows::LiftFile> lifts;
    if (is_there(session.file("lifts.csv")))
        lifts.emplace(rows::read_lifts(session.file("lifts.csv")));
    const EventRows maker(trials, lifts ? &*lifts : nullptr, info, session);
    const std::vector<Attempt> attempts = attempts_of(trials, session);

    std::vector<std::pair<double, Row>> rows;  // by onset [s]
    for (const Attempt& attempt : attempts) rows.emplace_back(attempt.start, maker.trial(attempt));
    for (const rows::EventRow& moment : moments) {
        if (moment.name == "trial") continue;  // the attempt has its own row
        const auto in_it = [&](const Attempt& a) {
            return a.start <= moment.time && moment.time <= a.stop;
        };
        const auto found = std::find_if(attempts.begin(), attempts.end(), in_it);
        rows.emplace_back(moment.time,
                          maker.moment(moment, found == attempts.end() ? nullptr : &*found));
    }
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Json json = sidecar(maker.columns(), info);
    describe_answers(read_frozen_task(session.file("task.yaml")), json);
    Events out{{maker.header()}, json.dump(2) + "\n"};
    for (auto& [time, row] : rows) out.rows.push_back(std::move(row));
    return out;
}

}  // namespace dihaptic::analysis::bids
