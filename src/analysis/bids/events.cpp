#include "analysis/bids/events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
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

constexpr const char* kLift = "lift_";  // prefix of the column names that come from lifts.csv

/// A column of the data set's table, and where its cells come from.
struct Column : Table::Column {
    enum class Of { asked, measured, lift };
    Of of = Of::asked;
    size_t from = 0;  ///< index of the column in trials.csv or lifts.csv
};

/// A trial attempt in this session, and the attempt's row in trials.csv.
struct Attempt {
    double start = 0;  // [s]
    double stop = 0;
    size_t row = 0;
};

/// Returns the attempts of this session only: trials.csv starts with the attempts of the sessions
/// that this session resumes.
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

/// Returns the columns made from trials.csv and lifts.csv, with their descriptions.
std::vector<Column> columns_for(const rows::TrialFile& trials, const rows::LiftFile* lifts,
                                const recording::SessionFolder& session,
                                const recording::SessionInfo& info) {
    std::vector<Column> out;
    const auto add = [&](const Table::Column& column, Column::Of of) {
        if (const auto from = trials.column(column.name)) out.push_back({column, of, *from});
    };
    // rows of events in a trial also contain what was known before the trial started
    std::vector<Table::Column> asked = list_figures(rows::AskedRow{}).columns;
    std::vector<Table::Column> measured = list_figures(rows::TrialMeasures{}).columns;
    asked.insert(asked.begin() + 1, measured.front());  // number of the attempt
    measured.erase(measured.begin());
    const task::Task task = read_frozen_task(session.file("task.yaml"));
    for (const Table::Column& c : asked) add(c, Column::Of::asked);
    for (const Table::Column& c : task::own_columns(task)) add(c, Column::Of::asked);
    for (const NumberColumn& c : columns_of_numbers(info))
        add(c, c.known_before ? Column::Of::asked : Column::Of::measured);
    // only the trial's own row contains its events and measures
    for (Table::Column& c : measure_columns_of(task)) measured.push_back(std::move(c));
    measured.push_back(kPartnerColumn);
    for (const Table::Column& c : measured) add(c, Column::Of::measured);
    if (lifts == nullptr) return out;
    const std::vector<Table::Column> of_lifts = list_figures(rows::LiftRow{}).columns;
    for (size_t i = 2; i < of_lifts.size(); ++i) {  // starts after the columns of trial and attempt
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

/// Adds the questions as descriptions of the answers' columns, and the labels of Likert scales as
/// descriptions of their levels.
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
    Json levels, tags;
    for (const rows::EventKind& kind : rows::kEventKinds) {
        levels[kind.name] = std::string("value: ") + kind.value;
        tags[kind.name] = fmt::format("({}, {{HED}})", kind.hed);  // including the tags of the row
    }
    levels["trial"] = "an attempt at a trial, with its demands and measures; value: its outcome";
    Json json{
        {"onset", {{"Description", "time from the first tick of the recording"}, {"Units", "s"}}},
        {"duration", {{"Description", "duration of a trial; n/a: a moment"}, {"Units", "s"}}},
        {"trial_type",
         {{"Description", "kind of event; outcomes and markers are the task's own"},
          {"Levels", levels},
          {"HED", tags}}},
        {"value", {{"Description", "value of the event, as described under trial_type"}}},
        {"moved_by", {{"Description", info.moved_by.describe()}}},
        {"simulated", {{"Description", recording::kMovedByColumns[0].description}}}};
    for (const Column& c : columns) {
        json[c.name]["Description"] = c.description;
        if (!c.unit.empty()) json[c.name]["Units"] = c.unit;
    }
    return json;
}

/// Returns a HED label: the row's number followed by the letters and digits of a text. The number
/// is needed because HED treats equal tags at the same time as an error.
std::string hed_label(size_t number, const std::string& text) {
    constexpr size_t kLongest = 60;
    std::string out = fmt::format("Label/{}-", number);
    for (const char c : text.substr(0, kLongest)) {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
            out += c;
        } else if (out.back() != '-') {
            out += '-';
        }
    }
    while (out.ends_with('-')) out.pop_back();
    return out;
}

/// The HED tags of a row that are not already given by the sidecar to all rows of its kind: the
/// row's label, and the tags that the task file assigns to the state, the outcome or the
/// perturbations.
class HedTags {
  public:
    explicit HedTags(const task::Task& task) : task_(task) {}

    /// Returns the tags of the next event. Events must be passed in time order. `number`: number of
    /// the row; `trial`: null between trials.
    std::string of(const rows::EventRow& event, size_t number, const rows::AskedRow* trial) {
        std::string out = hed_label(number, event.detail);
        const auto also = [&](const std::string& tags) {
            const std::string group = ", (" + tags + ")";
            if (!tags.empty() && out.find(group) == std::string::npos) out += group;
        };
        if (event.name == "phase") {
            state_ = event.detail;
            also(of_state(state_));
        }
        if (event.name == "outcome") also(of_outcome(event.detail));
        if (event.name != "perturbation" || event.detail != "on" || trial == nullptr) return out;
        for (const task::PerturbationSpec& spec : task_.perturbations) {
            if (!task::names_perturbation(trial->perturbation, spec.name)) continue;
            const task::PerturbationSpec& acting = of_trial(spec, *trial);
            const auto& during = static_cast<const Texts&>(acting.during);
            if (during.empty() || std::ranges::find(during, state_) != during.end())
                also(acting.hed);
        }
        return out;
    }

  private:
    /// Returns the perturbation that acts in a trial: a condition, or else a round, may replace the
    /// perturbation with one of the same name.
    const task::PerturbationSpec& of_trial(const task::PerturbationSpec& spec,
                                           const rows::AskedRow& trial) const {
        for (const auto& [list, name] : {std::pair(&task_.conditions, &trial.condition),
                                         std::pair(&task_.rounds, &trial.round)}) {
            for (const task::Condition& owner : *list) {
                if (owner.name != *name) continue;
                const auto own = std::ranges::find(owner.perturbations, spec.name,
                                                   &task::PerturbationSpec::name);
                if (own != owner.perturbations.end()) return *own;
            }
        }
        return spec;
    }
    std::string of_state(const std::string& name) const {
        for (const task::State& state : task_.states) {
            if (state.name == name) return state.hed;
        }
        return "";
    }
    std::string of_outcome(const std::string& name) const {
        for (const task::State& state : task_.states) {
            for (const task::Exit& exit : state.exits) {
                if (exit.outcome == name && !exit.hed.empty()) return exit.hed;
            }
        }
        return "";
    }

    const task::Task& task_;
    std::string state_;  // the last state that has started
};

class EventRows {
  public:
    EventRows(const rows::TrialFile& trials, const rows::LiftFile* lifts,
              const recording::SessionInfo& info, const recording::SessionFolder& session,
              HedTags& tags)
        : trials_(trials),
          lifts_(lifts),
          tags_(tags),
          by_(info.moved_by),
          columns_(columns_for(trials, lifts, session, info)) {
        for (size_t i = 0; lifts != nullptr && i < lifts->size(); ++i)
            lift_of_[{(*lifts)[i].trial, (*lifts)[i].attempt}] = i;
    }

    const std::vector<Column>& columns() const { return columns_; }
    Row header() const {
        Row row{"onset", "duration", "trial_type", "value"};
        for (const Column& c : columns_) row.push_back(c.name);
        row.insert(row.end(), {"simulated", "moved_by", "HED"});
        return row;
    }
    /// Row of an attempt, with all the data of the attempt.
    Row trial(const Attempt& attempt) const {
        const rows::TrialRow& of = trials_[attempt.row];
        Row row{number_text(of.head.start), fmt::format("{:.6g}", attempt.stop - attempt.start),
                "trial", of.measures.outcome};
        // without a task, lifts are numbered from 1 in each trial
        const auto lift = lift_of_.find({of.asked.trial, std::max(of.measures.attempt, 1)});
        for (const Column& c : columns_) {
            if (c.of != Column::Of::lift) {
                row.push_back(trials_.text(attempt.row, c.from));
            } else {
                row.push_back(lift == lift_of_.end() ? "" : lifts_->text(lift->second, c.from));
            }
        }
        return finished(row, hed_label(attempt.row + 1, fmt::format("trial {}", of.asked.trial)));
    }
    /// Row of an event, either in an attempt or between attempts.
    Row moment(const rows::EventRow& event, size_t number, const Attempt* attempt) const {
        Row row{number_text(event.time), "n/a", event.name, event.detail};
        for (const Column& c : columns_) {
            if (attempt != nullptr && c.of == Column::Of::asked) {
                row.push_back(trials_.text(attempt->row, c.from));
            } else {
                row.push_back(&c == &columns_.front() ? number_text(event.trial) : "");
            }
        }
        return finished(row, tags_.of(event, number,
                                      attempt == nullptr ? nullptr : &trials_[attempt->row].asked));
    }

  private:
    Row finished(Row row, const std::string& tags) const {
        row.insert(row.end(), {by_.simulated(), by_.name(), tags});
        return row;
    }

    const rows::TrialFile& trials_;
    const rows::LiftFile* lifts_;
    HedTags& tags_;
    const recording::MovedBy& by_;
    std::vector<Column> columns_;  // the first column holds the trial number
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
    const task::Task task = read_frozen_task(session.file("task.yaml"));
    HedTags tags(task);
    const EventRows maker(trials, lifts ? &*lifts : nullptr, info, session, tags);
    const std::vector<Attempt> attempts = attempts_of(trials, session);

    std::vector<std::pair<double, Row>> rows;  // sorted by onset [s]
    for (const Attempt& attempt : attempts) rows.emplace_back(attempt.start, maker.trial(attempt));
    for (const rows::EventRow& moment : moments) {
        if (moment.name == "trial") continue;  // the attempt already has a row
        if (moment.name == rows::kNote) continue;
        const auto in_it = [&](const Attempt& a) {
            return a.start <= moment.time && moment.time <= a.stop;
        };
        const auto found = std::find_if(attempts.begin(), attempts.end(), in_it);
        rows.emplace_back(moment.time, maker.moment(moment, rows.size() + 1,
                                                    found == attempts.end() ? nullptr : &*found));
    }
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Json json = sidecar(maker.columns(), info);
    describe_answers(task, json);
    Events out{{maker.header()}, json.dump(2) + "\n"};
    for (auto& [time, row] : rows) out.rows.push_back(std::move(row));
    return out;
}

}  // namespace dihaptic::analysis::bids
