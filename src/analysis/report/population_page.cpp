#include "analysis/report/population_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "analysis/report/measure_section.h"
#include "analysis/report/statistics.h"
#include "base/plural.h"
#include "task/plan/custom_measures.h"
#include "task/plan/levels.h"

namespace dihaptic::analysis {
namespace {

using Sessions = std::vector<const SessionData*>;

/// States in sentences who moved the hands.
std::string who_moved(const Sessions& sessions) {
    std::set<std::string> who;
    for (const SessionData* session : sessions) who.insert(session->info.moved_by.describe());
    return fmt::format("{}", fmt::join(who, " "));
}

/// A session's participant; sessions without a name count as different people.
std::string person_of(const SessionData& session) {
    const std::string& id = session.info.participant.id;
    return id.empty() ? session.folder.path() : id;
}

/// Values of people. A person with several sessions counts once, with the mean of their values.
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
    std::vector<std::vector<double>> values_;  // by person, in the order of their first sessions
};

size_t number_of_people(const Sessions& sessions) {
    std::set<std::string> people;
    for (const SessionData* session : sessions) people.insert(person_of(*session));
    return people.size();
}

/// The origin of these sessions' figures, for captions.
std::string origin_of(const Sessions& sessions, const std::string& folder) {
    std::set<std::string> programs;
    for (const SessionData* session : sessions) programs.insert(session->info.program);
    return fmt::format("{} {} in {}, {}", who_moved(sessions),
                       counted(static_cast<int64_t>(sessions.size()), "session"), folder,
                       fmt::join(programs, ", "));
}

/// Adds the source of the hands' movement to the table's rows from `first` on.
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
    std::optional<AdaptationFits> fits;
};

void add_person(PopulationPage& out, const std::string& title, const SessionData& session,
                const AdaptationCurve& curve, const std::optional<AdaptationFits>& fits,
                const std::string& note) {
    FigureLister row;
    row("experiment", title, "", "title");
    row("ppid", session.participant(), "", "participant");
    row("round", curve.round, "", "name");
    curve.list_landmarks(row);
    list_fits(row, fits, false);
    row("note", note, "", "unmeasured quantity");
    row("session", session.folder.path(), "", "folder");
    add_row(out.people, row);
}

/// Lists statistics over people.
void list(FigureLister& row, const Sample& people) {
    row("people", people.count, "1", "number");
    row("mean", people.mean, "1", "over people");
    row("sd", people.sd, "1", "over people");
    row("mean_low", people.mean_interval.low, "1", "its 95 % interval");
    row("mean_high", people.mean_interval.high, "1", "its upper end");
}

/// Adds the mean over people, trial by trial. Catch trials, whose positions differ between people,
/// and all but the last attempt at a trial are left out.
void add_mean_curve(PopulationPage& out, const std::string& title, const std::string& round,
                    const std::vector<PersonCurve>& people, const std::string& origin) {
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
    Sessions of_round;
    for (const PersonCurve& person : people) of_round.push_back(person.session);
    Series mean{"mean", Drawn::line, {}, {}, {}, {}, {}};
    std::vector<Mark> marks;
    std::string block;
    for (const auto& [place, values] : by_place) {
        const Sample all = values.over_people();
        mean.x.push_back(place);
        mean.y.push_back(all.mean);
        mean.low.push_back(all.count > 1 ? all.mean_interval.low : all.mean);
        mean.high.push_back(all.count > 1 ? all.mean_interval.high : all.mean);
        if (blocks[place] != block) {
            block = blocks[place];
            marks.push_back({static_cast<double>(place), block});
        }
        FigureLister row;
        row("experiment", title, "", "title");
        row("round", round, "", "name");
        row("unit", people.front().curve->unit, "", "unit of the means");
        row("trial", place, "1", "trial number in the round, from 1");
        row("block", block, "", "name");
        list(row, all);
        add_row(out.adaptation, row);
    }
    Chart chart;
    chart.title = "Mean compensation" + (round.empty() ? "" : ", " + round);
    chart.x_label = "trial";
    chart.y_label = y_label(*people.front().curve);
    chart.caption = fmt::format("Mean of {} people and its 95 % interval; without catch trials. {}",
                                number_of_people(of_round), origin);
    chart.series = {mean};
    chart.marks = marks;
    out.page.chart(chart);
}

/// Adds statistics over people for one round, whose rows start at `first` in population-people.csv,
/// one for each of these sessions.
void sum_up(Table& table, const std::string& round, const std::vector<PersonCurve>& sessions,
            const Table& people, size_t first) {
    for (size_t c = 0; c < people.columns.size(); ++c) {
        const std::string& name = people.columns[c].name;
        if (name.ends_with("_low") || name.ends_with("_high"))
            continue;  // limits of one person's interval
        ByPerson values;
        for (size_t i = 0; i < sessions.size(); ++i) {
            if (const auto* value = std::get_if<double>(&people.rows[first + i][c]))
                values.add(person_of(*sessions[i].session), *value);
        }
        const Sample all = values.over_people();
        if (all.count == 0) continue;
        table.rows.push_back({round, name, static_cast<double>(all.count), all.mean,
                              in_words(all.mean_interval), all.sd, all.median,
                              in_words(all.quartiles)});
    }
}

/// Adds the quantities without figures in these sessions, with the reasons.
void add_not_measured(PopulationPage& out, const std::string& title, const Sessions& sessions) {
    std::set<std::string> all;
    for (const SessionData* session : sessions) {
        if (session->unmeasured.empty()) continue;
        all.insert(session->not_measured());
        AdaptationCurve none;
        none.unit = none.measure = "";
        if (session->curves.empty())
            add_person(out, title, *session, none, {}, "not measured: " + session->not_measured());
    }
    if (all.empty()) return;
    out.page.text(
        fmt::format("Dihaptic does not yet measure the learning of these perturbations: {}. "
                    "Figures of trials under them are empty.",
                    fmt::join(all, "; ")));
}

void add_adaptation(PopulationPage& out, const std::string& title, const Sessions& sessions,
                    const std::string& origin) {
    std::map<std::string, std::vector<PersonCurve>> by_round;
    for (const SessionData* session : sessions) {
        for (const AdaptationCurve& curve : session->curves)
            by_round[curve.round].push_back({session, &curve, fit_adaptation(curve)});
    }
    if (by_round.empty()) return;
    Table table;
    table.columns = {{"round", ""},     {"figure", ""}, {"people", ""}, {"mean", ""},
                     {"mean 95 %", ""}, {"SD", ""},     {"median", ""}, {"quartiles", ""}};
    for (const auto& [round, people] : by_round) {
        const size_t first = out.people.rows.size();
        add_mean_curve(out, title, round, people, origin);
        for (const PersonCurve& p : people)
            add_person(out, title, *p.session, *p.curve, p.fits, p.curve->note());
        sum_up(table, round, people, out.people, first);
    }
    out.page.table(table, "Over people; population-people.csv lists each session. " + origin);
}

void add_thresholds(PopulationPage& out, const std::string& title, const Sessions& sessions,
                    const std::string& origin) {
    std::vector<std::string> procedures;
    std::map<std::string, ByPerson> shares;
    int not_counted = 0;
    for (const SessionData* session : sessions) {
        for (const ThresholdTrack& track : session->tracks) {
            const ThresholdFit threshold = fit_threshold(track);
            if (!shares.contains(track.procedure)) procedures.push_back(track.procedure);
            ByPerson& of_people = shares[track.procedure];
            const model::Psychometric f = threshold.function();
            FigureLister row;
            row("experiment", title, "", "title");
            row("ppid", session->participant(), "", "participant");
            row("procedure", track.procedure, "", "name");
            row("perturbation", track.perturbation, "", "name");
            row("chooses", track.what(), "", "quantity of the levels");
            row("trials", track.answers.size(), "1", "answers");
            row("threshold_share", track.share(f.threshold), "1",
                "share of the perturbation; or the number, in the unit of its name");
            list_psychophysics(track, f, row);
            row("shape", f.shape, "1", "shape of the sigmoid");
            row("lapse", f.lapse, "1", "share of answers that do not depend on the level");
            row("note", threshold.note, "", "reason for a missing fit, or a remark");
            row("session", session->folder.path(), "", "folder");
            add_row(out.thresholds, row);
            const bool counts = threshold.fit && !threshold.outside;
            if (counts) of_people.add(person_of(*session), track.share(f.threshold));
            not_counted += !counts;
        }
    }
    if (procedures.empty()) return;
    Table table;
    table.columns = {
        {"procedure", ""}, {"people", ""}, {"mean", ""}, {"mean 95 %", ""}, {"SD", ""}};
    for (const std::string& procedure : procedures) {
        const Sample all = shares[procedure].over_people();
        table.rows.push_back({procedure, static_cast<double>(all.count), all.mean,
                              in_words(all.mean_interval), all.sd});
    }
    std::string caption =
        "Thresholds over people, as shares of the perturbation or numbers in the unit of their "
        "names. ";
    if (not_counted > 0) {
        caption += fmt::format(
            "{} not counted, because there is no fit or the threshold lies outside the levels that "
            "were shown: population-thresholds.csv gives the reasons. ",
            not_counted == 1 ? "One is" : fmt::format("{} are", not_counted));
    }
    out.page.table(table, caption + origin);
}

void add_lifts(PopulationPage& out, const std::string& title, const Sessions& sessions,
               const std::string& origin) {
    // first each session's median, because people differ more than lifts
    std::vector<std::string> groups;
    std::map<std::string, std::map<std::string, ByPerson>> medians;
    int lifts = 0;
    int complete = 0;
    for (const SessionData* session : sessions) {
        std::map<std::string, std::vector<rows::LiftRow>> by_group;
        const std::vector<std::string> group_of = groups_of_lifts(*session);
        for (size_t i = 0; i < group_of.size(); ++i) {
            const rows::LiftRow& lift = (*session->lifts)[i];
            by_group[group_of[i]].push_back(lift);
            ++lifts;
            complete += lift.complete();
        }
        for (const auto& [group, own] : by_group) {
            if (!medians.contains(group)) groups.push_back(group);
            for (const auto figure : kLiftFigures)
                medians[group][figure_column(figure).column.name].add(
                    person_of(*session), sample(values_of(own, figure)).median);
        }
    }
    if (groups.empty()) return;
    Table table;
    table.columns = {{"trials", ""}, {"figure", ""},    {"people", ""},
                     {"mean", ""},   {"mean 95 %", ""}, {"SD", ""}};
    for (const std::string& group : groups) {
        for (const auto of : kLiftFigures) {
            const std::string figure = figure_column(of).column.name;
            const Sample all = medians[group][figure].over_people();
            if (all.count == 0) continue;
            table.rows.push_back({group, figure, static_cast<double>(all.count), all.mean,
                                  in_words(all.mean_interval), all.sd});
            FigureLister row;
            row("experiment", title, "", "title");
            row("trials", group, "", "round, block, kind, condition");
            row("figure", figure, "", "column of lifts.csv; each person's median counts");
            list(row, all);
            add_row(out.lifts, row);
        }
    }
    out.page.text(fmt::format("{} lifts, {} of them complete.", lifts, complete));
    out.page.table(table, "Over people, of each person's median. " + origin);
}

/// Lists the measures and answers of the last attempts at trials, by the study's group and session,
/// and by round, block, condition, kind of trials and perturbation.
void list_measures(PopulationPage& out, const std::string& title, const Sessions& sessions) {
    // group, session, round, block, condition, kind, perturbation
    using Key = std::array<std::string, 7>;
    std::vector<Table::Column> columns = measured_columns(*sessions.front());
    const size_t measures = columns.size();
    for (Table::Column& answer : task::columns_of(task::questions_of(sessions.front()->task)))
        columns.push_back(std::move(answer));
    for (size_t c = 0; c < columns.size(); ++c) {
        const Table::Column& column = columns[c];
        std::map<Key, ByPerson> values;
        std::map<Key, int> trials_of, empty;
        for (const SessionData* session : sessions) {
            const rows::TrialFile& trials = session->trials;
            const auto measured = trials.column(column.name);
            const recording::InStudy in_study =
                session->info.in_study.value_or(recording::InStudy{});
            std::map<int, size_t> last;  // row of the last attempt, by trial
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
                if (!std::isnan(value)) of_people.add(person_of(*session), value);
            }
        }
        for (const auto& [key, of_people] : values) {
            if (c >= measures && empty[key] == trials_of[key]) continue;  // not asked for there
            FigureLister row;
            row("experiment", title, "", "title");
            row("group", key[0], "", "group of the study; empty: none");
            row("study_session", key[1], "", "session of the study; empty: none");
            row("measure", column.name, "", "column of trials.csv; each person's mean counts");
            row("unit", column.unit, "", "its unit");
            row("round", key[2], "", "name");
            row("block", key[3], "", "name");
            row("condition", key[4], "", "name");
            row("kind", key[5], "", "kind of the trials");
            row("perturbation", key[6], "", "name, or names joined by ' + '; empty: none");
            row("trials", trials_of[key], "1", "number over all people, the last attempt at each");
            row("left_out", empty[key], "1", "trials without the measure: not_measured says why");
            const Sample all = of_people.over_people();
            list(row, all);
            row("median", all.median, "", "over people");
            row("lower_quartile", all.quartiles.low, "", "over people");
            row("upper_quartile", all.quartiles.high, "", "over people");
            add_row(out.measures, row);
        }
    }
}

std::array<Table*, 5> tables_of(PopulationPage& page) {
    return {&page.people, &page.adaptation, &page.thresholds, &page.lifts, &page.measures};
}

/// Adds the sessions of one experiment and one kind of people.
void add_group(PopulationPage& out, const std::string& title, const std::string& who,
               const Sessions& sessions, const std::string& folder) {
    const std::string origin = origin_of(sessions, folder);
    std::vector<size_t> first;
    for (const Table* table : tables_of(out)) first.push_back(table->rows.size());
    const std::string& population = sessions.front()->info.moved_by.population;
    out.page.heading(population.empty() ? title : title + ": " + population);
    std::set<std::string> names;
    for (const SessionData* session : sessions) names.insert(session->participant());
    const size_t people = number_of_people(sessions);
    const std::string of = people == 1 ? "one participant" : fmt::format("{} participants", people);
    out.page.text(fmt::format("{} {} of {}: {}.", who,
                              counted(static_cast<int64_t>(sessions.size()), "session"), of,
                              fmt::join(names, ", ")));
    if (sessions.size() > people) {
        out.page.text(
            "Some participants have several sessions and count once in the means below, with the "
            "mean of these sessions. population-people.csv lists each session.");
    }
    add_not_measured(out, title, sessions);
    add_adaptation(out, title, sessions, origin);
    add_measures_of_people(out.page, sessions, origin);
    list_measures(out, title, sessions);
    add_thresholds(out, title, sessions, origin);
    add_lifts(out, title, sessions, origin);
    const auto tables = tables_of(out);
    for (size_t i = 0; i < tables.size(); ++i)
        mark(*tables[i], first[i], sessions.front()->info.moved_by);
}

}  // namespace

PopulationPage population_page(const std::vector<SessionData>& sessions, const std::string& folder,
                               const std::string& command) {
    // simulated and real people, or two populations, never count as one sample
    using Group = std::pair<std::string, std::string>;  // the title, and who moved the hands
    std::set<std::string> titles;
    std::map<Group, Sessions> groups;
    Sessions all;
    for (const SessionData& session : sessions) {
        titles.insert(session.info.title);
        groups[{session.info.title, session.info.moved_by.describe()}].push_back(&session);
        all.push_back(&session);
    }
    PopulationPage out{
        Page(titles.size() == 1 ? *titles.begin() : fmt::format("{} experiments", titles.size()),
             who_moved(all),
             fmt::format("{}. Made by {} with: {}", origin_of(all, folder),
                         recording::program_version(), command))};
    std::vector<Problem> changed;
    for (const SessionData& session : sessions)
        changed.insert(changed.end(), session.changed.begin(), session.changed.end());
    out.page.problems("Changed since the sessions ended", changed);
    for (const auto& [group, list] : groups)
        add_group(out, group.first, group.second, list, folder);
    for (Table* table : tables_of(out)) {
        table->columns.insert(table->columns.end(), recording::kMovedByColumns.begin(),
                              recording::kMovedByColumns.end());
        table->columns.push_back({"population", "of simulated people, with their group"});
    }
    return out;
}

}  // namespace dihaptic::analysis
