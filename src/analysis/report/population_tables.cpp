#include "analysis/report/population_tables.h"

#include <array>
#include <cmath>
#include <map>

#include "analysis/measures/measures.h"
#include "analysis/report/statistics.h"
#include "task/plan/custom_measures.h"
#include "task/plan/levels.h"
#include "task/plan/measures.h"

namespace dihaptic::analysis {
namespace {

/// A session's participant. Sessions without a participant ID count as different people.
std::string person_of(const SessionData& session) {
    const std::string& id = session.info.participant.id;
    return id.empty() ? session.folder.path() : id;
}

/// Values per person. A person with several sessions counts once, with the mean of the sessions'
/// values.
class ByPerson {
  public:
    void add(const std::string& person, double value) {
        const auto [at, is_new] = index_.emplace(person, values_.size());
        if (is_new) values_.emplace_back();
        values_[at->second].push_back(value);
    }
    Sample over_people() const {
        std::vector<double> means;
        for (const std::vector<double>& of_person : values_)
            means.push_back(sample(of_person).mean);
        return sample(means);
    }

  private:
    std::map<std::string, size_t> index_;
    std::vector<std::vector<double>> values_;  // values of each person, ordered by first session
};

/// Marks the table's rows from `first` on with the source of the hand movement.
void mark(Table& table, size_t first, const recording::MovedBy& by) {
    for (size_t i = first; i < table.rows.size(); ++i) {
        table.rows[i].emplace_back(by.simulated());
        table.rows[i].emplace_back(by.name());
        table.rows[i].emplace_back(by.population);
    }
}

/// One person's compensation in one round.
struct PersonCurve {
    const SessionData* session;
    const AdaptationCurve* curve;
    const std::optional<AdaptationFits>* fits;
};

void add_person(PopulationTables& out, const std::string& title, const SessionData& session,
                const AdaptationCurve& curve, const std::optional<AdaptationFits>& fits,
                const std::string& note) {
    FigureLister row;
    row("experiment", title, "", "title");
    row("ppid", session.participant(), "", "participant");
    row("round", curve.round, "", "name");
    curve.list_landmarks(row);
    list_fits(row, fits, false);
    row("note", note, "", "what is not measured");
    row("session", session.folder.path(), "", "folder");
    add_row(out.people, row);
}

/// Lists the statistics of a sample of people.
void list(FigureLister& row, const Sample& people) {
    row("people", people.count, "1", "number of people");
    row("mean", people.mean, "1", "mean over people");
    row("sd", people.sd, "1", "standard deviation over people");
    row("mean_low", people.mean_interval.low, "1", "lower end of the mean's 95 % interval");
    row("mean_high", people.mean_interval.high, "1", "upper end of that interval");
}

/// Adds the mean over people for each trial. Leaves out catch trials, whose positions differ
/// between people, and all but the last attempt at each trial.
void add_mean_curve(PopulationTables& out, const std::string& title, const std::string& round,
                    const std::vector<PersonCurve>& people) {
    std::map<int, ByPerson> by_place;
    std::map<int, std::string> blocks;
    for (const PersonCurve& person : people) {
        const int first = person.curve->trials.front().number;
        std::map<int, double> own;
        for (const AdaptationCurve::Trial& trial : person.curve->trials) {
            const int place = trial.number - first + 1;
            if (trial.kind == rows::TrialKind::catch_trial) continue;
            own[place] = trial.compensation;
            blocks[place] = trial.block;
        }
        for (const auto& [place, x] : own) by_place[place].add(person_of(*person.session), x);
    }
    for (const auto& [place, values] : by_place) {
        FigureLister row;
        row("experiment", title, "", "title");
        row("round", round, "", "name");
        row("unit", people.front().curve->unit, "", "unit of the means");
        row("trial", place, "1", "trial number in the round, from 1");
        row("block", blocks[place], "", "name");
        list(row, values.over_people());
        add_row(out.adaptation, row);
    }
}

/// Adds the sessions with perturbations for which learning has no measure, with the reasons.
void add_not_measured(PopulationTables& out, const std::string& title, const Sessions& sessions) {
    for (const FittedSession* session : sessions) {
        const SessionData& data = session->data;
        if (data.unmeasured.empty() || !data.curves.empty()) continue;
        AdaptationCurve none;
        none.unit = none.measure = "";
        add_person(out, title, data, none, {}, "not measured: " + data.not_measured());
    }
}

void add_adaptation(PopulationTables& out, const std::string& title, const Sessions& sessions) {
    std::map<std::string, std::vector<PersonCurve>> by_round;
    for (const FittedSession* session : sessions) {
        const std::vector<AdaptationCurve>& curves = session->data.curves;
        for (size_t i = 0; i < curves.size(); ++i)
            by_round[curves[i].round].push_back(
                {&session->data, &curves[i], &session->adaptation[i]});
    }
    for (const auto& [round, people] : by_round) {
        add_mean_curve(out, title, round, people);
        for (const PersonCurve& p : people)
            add_person(out, title, *p.session, *p.curve, *p.fits, p.curve->note());
    }
}

void add_thresholds(PopulationTables& out, const std::string& title, const Sessions& sessions) {
    for (const FittedSession* session : sessions) {
        const SessionData& data = session->data;
        for (size_t i = 0; i < data.tracks.size(); ++i) {
            const ThresholdTrack& track = data.tracks[i];
            const ThresholdFit& threshold = session->thresholds[i];
            const model::Psychometric f = threshold.function();
            FigureLister row;
            row("experiment", title, "", "title");
            row("ppid", data.participant(), "", "participant");
            row("procedure", track.procedure, "", "name");
            row("perturbation", track.perturbation, "", "name");
            row("chooses", track.what(), "", "quantity of the levels");
            row("trials", track.answers.size(), "1", "number of answers");
            row("threshold_share", track.share(f.threshold), "1",
                "share of the perturbation; or the chosen number, in the unit that its name "
                "states");
            list_psychophysics(track, f, row);
            row("shape", f.shape, "1", "shape of the sigmoid");
            row("lapse", f.lapse, "1", "share of answers that do not depend on the level");
            row("note", threshold.note, "", "reason for a missing fit, or a remark");
            row("session", data.folder.path(), "", "folder");
            add_row(out.thresholds, row);
        }
    }
}

/// The lift figures whose medians appear in the tables over people.
constexpr double rows::LiftRow::*kLiftFigures[] = {
    &rows::LiftRow::preload,        &rows::LiftRow::loading,       &rows::LiftRow::peak_grip_rate,
    &rows::LiftRow::peak_load_rate, &rows::LiftRow::peak_grip,     &rows::LiftRow::static_grip,
    &rows::LiftRow::static_load,    &rows::LiftRow::static_ratio,  &rows::LiftRow::safety_margin,
    &rows::LiftRow::grip_load_r,    &rows::LiftRow::grip_load_lag, &rows::LiftRow::overshoot};

/// Returns one figure of each of the lifts, in the unit of the figure's column.
template <class Lifts, class Member>
std::vector<double> values_of(const Lifts& lifts, Member rows::LiftRow::*figure) {
    const double scale = figure_column(figure).scale;
    std::vector<double> out;
    for (const rows::LiftRow& lift : lifts) out.push_back(scale * lift.*figure);
    return out;
}

void add_lifts(PopulationTables& out, const std::string& title, const Sessions& sessions) {
    // the median of each session is taken first, because people differ more than lifts do
    std::vector<std::string> groups;
    std::map<std::string, std::map<std::string, ByPerson>> medians;
    for (const FittedSession* session : sessions) {
        const SessionData& data = session->data;
        std::map<std::string, std::vector<rows::LiftRow>> by_group;
        const std::vector<std::string> group_of = groups_of_lifts(data);
        for (size_t i = 0; i < group_of.size(); ++i)
            by_group[group_of[i]].push_back((*data.lifts)[i]);
        for (const auto& [group, own] : by_group) {
            if (!medians.contains(group)) groups.push_back(group);
            for (const auto figure : kLiftFigures)
                medians[group][figure_column(figure).column.name].add(
                    person_of(data), sample(values_of(own, figure)).median);
        }
    }
    for (const std::string& group : groups) {
        for (const auto of : kLiftFigures) {
            const std::string figure = figure_column(of).column.name;
            const Sample all = medians[group][figure].over_people();
            if (all.count == 0) continue;
            FigureLister row;
            row("experiment", title, "", "title");
            row("trials", group, "", "round, block, kind, condition");
            row("figure", figure, "", "column of lifts.csv; each person's median of it is used");
            list(row, all);
            add_row(out.lifts, row);
        }
    }
}

/// Returns the columns of trials.csv that contain the task's measures.
std::vector<Table::Column> measured_columns(const SessionData& session) {
    const rows::TrialFile& trials = session.trials;
    std::vector<Table::Column> out = measure_columns_of(session.task);
    out.pop_back();  // drop the column that lists the missing measures
    std::erase_if(out, [&](const Table::Column& c) { return !trials.column(c.name); });
    // if the session has no measures, a column with such a name is something else
    if (!trials.column(task::kNotMeasured)) out.clear();
    return out;
}

/// Lists the measures and answers of the last attempt at each trial, grouped by the study's group
/// and session, and by round, block, condition, kind of trial and perturbation.
void list_measures(PopulationTables& out, const std::string& title, const Sessions& sessions) {
    // group, session, round, block, condition, kind, perturbation
    using Key = std::array<std::string, 7>;
    std::vector<Table::Column> columns = measured_columns(sessions.front()->data);
    const size_t measures = columns.size();
    for (Table::Column& answer : task::columns_of(task::questions_of(sessions.front()->data.task)))
        columns.push_back(std::move(answer));
    for (size_t c = 0; c < columns.size(); ++c) {
        const Table::Column& column = columns[c];
        std::map<Key, ByPerson> values;
        std::map<Key, int> trials_of, empty;
        for (const FittedSession* session : sessions) {
            const SessionData& data = session->data;
            const rows::TrialFile& trials = data.trials;
            const auto measured = trials.column(column.name);
            const recording::InStudy in_study = data.info.in_study.value_or(recording::InStudy{});
            std::map<int, size_t> last;  // row of the last attempt, indexed by trial
            for (size_t i = 0; i < trials.size(); ++i) last[trials[i].asked.trial] = i;
            for (const auto& [trial, i] : last) {
                const rows::AskedRow& asked = trials[i].asked;
                const Key key{in_study.group,    in_study.session,
                              asked.round,       asked.block,
                              asked.condition,   std::string(enum_name(asked.kind)),
                              asked.perturbation};
                const double value = trials.number(i, measured);
                ++trials_of[key];
                empty[key] += std::isnan(value) ? 1 : 0;
                ByPerson& of_people = values[key];
                if (!std::isnan(value)) of_people.add(person_of(data), value);
            }
        }
        for (const auto& [key, of_people] : values) {
            if (c >= measures && empty[key] == trials_of[key])
                continue;  // the measure was not requested in these trials
            FigureLister row;
            row("experiment", title, "", "title");
            row("group", key[0], "", "group of the study; empty: none");
            row("study_session", key[1], "", "session of the study; empty: none");
            row("measure", column.name, "",
                "column of trials.csv; each person's mean of it is used");
            row("unit", column.unit, "", "its unit");
            row("round", key[2], "", "name");
            row("block", key[3], "", "name");
            row("condition", key[4], "", "name");
            row("kind", key[5], "", "kind of the trials");
            row("perturbation", key[6], "", "name, or names joined by ' + '; empty: none");
            row("trials", trials_of[key], "1",
                "number over all people; only the last attempt at each trial");
            row("left_out", empty[key], "1",
                "trials without the measure; not_measured gives the reason");
            const Sample all = of_people.over_people();
            list(row, all);
            row("median", all.median, "", "median over people");
            row("lower_quartile", all.quartiles.low, "", "lower quartile over people");
            row("upper_quartile", all.quartiles.high, "", "upper quartile over people");
            add_row(out.measures, row);
        }
    }
}

std::array<Table*, 5> tables_of(PopulationTables& tables) {
    return {&tables.people, &tables.adaptation, &tables.thresholds, &tables.lifts,
            &tables.measures};
}

/// Adds the tables for the sessions of one sample.
void add_sample(PopulationTables& out, const Sessions& sessions) {
    std::vector<size_t> first;
    for (const Table* table : tables_of(out)) first.push_back(table->rows.size());
    const recording::SessionInfo& info = sessions.front()->data.info;
    add_not_measured(out, info.title, sessions);
    add_adaptation(out, info.title, sessions);
    list_measures(out, info.title, sessions);
    add_thresholds(out, info.title, sessions);
    add_lifts(out, info.title, sessions);
    const auto tables = tables_of(out);
    for (size_t i = 0; i < tables.size(); ++i) mark(*tables[i], first[i], info.moved_by);
}

}  // namespace

std::vector<Sessions> samples_of(const std::vector<FittedSession>& sessions) {
    std::map<std::pair<std::string, std::string>, Sessions> samples;
    for (const FittedSession& session : sessions) {
        const recording::SessionInfo& info = session.data.info;
        samples[{info.title, info.moved_by.describe()}].push_back(&session);
    }
    std::vector<Sessions> out;
    for (auto& [unused, of_sample] : samples) out.push_back(std::move(of_sample));
    return out;
}

PopulationTables population_tables(const std::vector<Sessions>& samples) {
    PopulationTables out;
    for (const Sessions& sessions : samples) add_sample(out, sessions);
    for (Table* table : tables_of(out)) {
        table->columns.insert(table->columns.end(), recording::kMovedByColumns.begin(),
                              recording::kMovedByColumns.end());
        table->columns.push_back(
            {"population", "population of the simulated people, with their group"});
    }
    return out;
}

}  // namespace dihaptic::analysis
