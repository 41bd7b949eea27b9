#include "analysis/report/population_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "analysis/report/statistics.h"
#include "base/plural.h"

namespace dihaptic::analysis {
namespace {

using Sessions = std::vector<const SessionData*>;

/// Says in sentences who moved the hands.
std::string who_moved(const Sessions& sessions) {
    std::set<std::string> who;
    for (const SessionData* session : sessions) who.insert(session->info.moved_by.describe());
    return fmt::format("{}", fmt::join(who, " "));
}

/// The origin of these sessions' figures, for captions.
std::string origin_of(const Sessions& sessions, const std::string& folder) {
    std::set<std::string> programs;
    for (const SessionData* session : sessions) programs.insert(session->info.program);
    return fmt::format("{} {} in {}, {}", who_moved(sessions),
                       counted(static_cast<int64_t>(sessions.size()), "session"), folder,
                       fmt::join(programs, ", "));
}

/// Adds to the table's rows from `first` on what moved the hands of their sessions.
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

void add_people(PopulationPage& out, const std::string& title,
                const std::vector<PersonCurve>& people) {
    for (const PersonCurve& person : people) {
        std::vector<Table::Cell>& row = out.people.rows.emplace_back();
        const std::vector<Table::Cell> landmarks = person.curve->landmark_cells();
        row = {title, person.session->participant(), person.curve->round};
        row.insert(row.end(), landmarks.begin(), landmarks.end());
        if (!person.fits) {
            row.resize(out.people.columns.size() - 2, AdaptationCurve::kNone);
        } else {
            const model::TwoRate& rates = person.fits->two_rate.rates;
            row.insert(row.end(), {rates.fast.retention, rates.fast.learning, rates.slow.retention,
                                   rates.slow.learning, person.fits->two_rate.residual_sd,
                                   person.fits->single_rate.rate.retention,
                                   person.fits->single_rate.rate.learning});
        }
        row.insert(row.end(), {person.curve->note(), person.session->folder.path()});
    }
}

/// Adds a row without figures for a session whose perturbation has no measure of learning.
void add_unmeasured(PopulationPage& out, const std::string& title, const SessionData& session) {
    std::vector<Table::Cell>& row = out.people.rows.emplace_back();
    row = {title, session.participant(), "", ""};
    row.resize(out.people.columns.size() - 2, AdaptationCurve::kNone);
    row.insert(row.end(), {"not measured: " + session.not_measured(), session.folder.path()});
}

/// Adds the mean over people, trial by trial. Catch trials, which come at different places for each
/// person, and all but the last attempt at a trial are left out.
void add_mean_curve(PopulationPage& out, const std::string& title, const std::string& round,
                    const std::vector<PersonCurve>& people, const std::string& origin) {
    std::map<int, std::vector<double>> by_place;
    std::map<int, std::string> blocks;
    for (const PersonCurve& person : people) {
        const int first = person.curve->trials.front().number;
        std::map<int, double> own;
        for (const AdaptationCurve::Trial& trial : person.curve->trials) {
            const int place = trial.number - first + 1;
            if (trial.kind == "catch") continue;
            own[place] = trial.compensation;
            blocks[place] = trial.block;
        }
        for (const auto& [place, x] : own) by_place[place].push_back(x);
    }
    Series mean{"mean", Drawn::line, {}, {}, {}, {}, {}};
    std::vector<Mark> marks;
    std::string block;
    for (const auto& [place, values] : by_place) {
        const Sample all = sample(values);
        mean.x.push_back(place);
        mean.y.push_back(all.mean);
        mean.low.push_back(all.count > 1 ? all.mean_interval.low : all.mean);
        mean.high.push_back(all.count > 1 ? all.mean_interval.high : all.mean);
        if (blocks[place] != block) {
            block = blocks[place];
            marks.push_back({static_cast<double>(place), block});
        }
        out.adaptation.rows.push_back({title, round, people.front().curve->unit,
                                       static_cast<double>(place), block,
                                       static_cast<double>(all.count), all.mean, all.sd,
                                       all.mean_interval.low, all.mean_interval.high});
    }
    Chart chart;
    chart.title = "Mean compensation" + (round.empty() ? "" : ", " + round);
    chart.x_label = "trial";
    chart.y_label = "compensation [" + people.front().curve->unit + "]";
    chart.caption = fmt::format("Mean of {} people and its 95 % interval; without catch trials. {}",
                                people.size(), origin);
    chart.series = {mean};
    chart.marks = marks;
    out.page.chart(chart);
}

/// Adds statistics over people of the numeric columns of population-people.csv.
void add_adaptation_summary(PopulationPage& out, size_t first_row, const std::string& origin) {
    Table table;
    table.columns = {{"round", ""},     {"figure", ""}, {"people", ""}, {"mean", ""},
                     {"mean 95 %", ""}, {"SD", ""},     {"median", ""}, {"quartiles", ""}};
    std::vector<std::string> rounds;
    for (size_t i = first_row; i < out.people.rows.size(); ++i) {
        const std::string& round = std::get<std::string>(out.people.rows[i][2]);
        if (std::find(rounds.begin(), rounds.end(), round) == rounds.end()) rounds.push_back(round);
    }
    for (const std::string& round : rounds) {
        for (size_t c = 4; c + 2 < out.people.columns.size(); ++c) {
            const std::string& name = out.people.columns[c].name;
            if (name.ends_with("_low") || name.ends_with("_high"))
                continue;  // intervals of one person
            std::vector<double> values;
            for (size_t i = first_row; i < out.people.rows.size(); ++i) {
                if (std::get<std::string>(out.people.rows[i][2]) == round)
                    values.push_back(std::get<double>(out.people.rows[i][c]));
            }
            const Sample all = sample(values);
            if (all.count == 0) continue;
            table.rows.push_back({round, name, static_cast<double>(all.count), all.mean,
                                  in_words(all.mean_interval), all.sd, all.median,
                                  in_words(all.quartiles)});
        }
    }
    out.page.table(table, "Over people; population-people.csv has each of them. " + origin);
}

/// Adds what has no figure in these sessions, and why.
void add_not_measured(PopulationPage& out, const std::string& title, const Sessions& sessions) {
    std::set<std::string> all;
    for (const SessionData* session : sessions) {
        if (session->unmeasured.empty()) continue;
        all.insert(session->not_measured());
        if (session->curves.empty()) add_unmeasured(out, title, *session);
    }
    if (all.empty()) return;
    out.page.text(fmt::format(
        "Dihaptic has no measure yet of what is learned of these perturbations: {}. Figures of "
        "trials under them are empty.",
        fmt::join(all, "; ")));
}

void add_adaptation(PopulationPage& out, const std::string& title, const Sessions& sessions,
                    const std::string& origin) {
    std::vector<std::string> rounds;
    std::map<std::string, std::vector<PersonCurve>> by_round;
    for (const SessionData* session : sessions) {
        for (const AdaptationCurve& curve : session->curves) {
            auto& people = by_round[curve.round];
            if (people.empty()) rounds.push_back(curve.round);
            people.push_back({session, &curve, fit_adaptation(curve)});
        }
    }
    if (rounds.empty()) return;
    // people do the rounds in different orders
    std::sort(rounds.begin(), rounds.end());
    const size_t first_row = out.people.rows.size();
    for (const std::string& round : rounds) {
        add_mean_curve(out, title, round, by_round[round], origin);
        add_people(out, title, by_round[round]);
    }
    add_adaptation_summary(out, first_row, origin);
}

void add_thresholds(PopulationPage& out, const std::string& title, const Sessions& sessions,
                    const std::string& origin) {
    std::vector<std::string> procedures;
    std::map<std::string, std::vector<double>> shares;
    int not_counted = 0;
    for (const SessionData* session : sessions) {
        for (const ThresholdTrack& track : session->tracks) {
            const ThresholdFit threshold = fit_threshold(track);
            if (!shares.contains(track.procedure)) procedures.push_back(track.procedure);
            std::vector<double>& of_people = shares[track.procedure];
            std::vector<Table::Cell>& row = out.thresholds.rows.emplace_back();
            row = {title, session->participant(), track.procedure, track.perturbation,
                   static_cast<double>(track.answers.size())};
            if (threshold.fit) {
                const model::Psychometric& f = threshold.fit->function;
                row.insert(row.end(), {track.share(f.threshold), f.shape, f.lapse});
                if (!threshold.outside) of_people.push_back(track.share(f.threshold));
            } else {
                row.resize(row.size() + 3, AdaptationCurve::kNone);
            }
            row.insert(row.end(), {threshold.note, session->folder.path()});
            not_counted += !threshold.fit || threshold.outside;
        }
    }
    if (procedures.empty()) return;
    Table table;
    table.columns = {
        {"procedure", ""}, {"people", ""}, {"mean", ""}, {"mean 95 %", ""}, {"SD", ""}};
    for (const std::string& procedure : procedures) {
        const Sample all = sample(shares[procedure]);
        table.rows.push_back({procedure, static_cast<double>(all.count), all.mean,
                              in_words(all.mean_interval), all.sd});
    }
    std::string caption = "Thresholds over people, as shares of the perturbation. ";
    if (not_counted > 0) {
        caption += fmt::format(
            "{} not counted, since there is no fit or the threshold lies outside of the levels "
            "that "
            "were shown: population-thresholds.csv says which, and why. ",
            not_counted == 1 ? "One is" : fmt::format("{} are", not_counted));
    }
    out.page.table(table, caption + origin);
}

void add_lifts(PopulationPage& out, const std::string& title, const Sessions& sessions,
               const std::string& origin) {
    static const std::vector<const char*> kFigures = {
        "preload_s",     "loading_s",     "peak_grip_rate_N_s", "peak_load_rate_N_s",
        "peak_grip_N",   "static_grip_N", "static_load_N",      "static_ratio",
        "safety_margin", "coupling",      "coupling_lag_s",     "overshoot_mm"};
    // each person's median comes first, since people differ more than lifts do
    std::vector<std::string> groups;
    std::map<std::string, std::map<std::string, std::vector<double>>> medians;
    int lifts = 0;
    int complete = 0;
    for (const SessionData* session : sessions) {
        std::map<std::string, std::vector<size_t>> rows;
        for (const LiftRow& lift : lift_rows(*session)) {
            rows[lift.group].push_back(lift.row);
            ++lifts;
            complete += session->lifts->text(lift.row, "lift") == "complete";
        }
        for (const auto& [group, of_group] : rows) {
            if (!medians.contains(group)) groups.push_back(group);
            for (const char* figure : kFigures) {
                std::vector<double> values;
                for (const size_t i : of_group) values.push_back(session->lifts->number(i, figure));
                medians[group][figure].push_back(sample(values).median);
            }
        }
    }
    if (groups.empty()) return;
    Table table;
    table.columns = {{"trials", ""}, {"figure", ""},    {"people", ""},
                     {"mean", ""},   {"mean 95 %", ""}, {"SD", ""}};
    for (const std::string& group : groups) {
        for (const char* figure : kFigures) {
            const Sample all = sample(medians[group][figure]);
            if (all.count == 0) continue;
            table.rows.push_back({group, std::string(figure), static_cast<double>(all.count),
                                  all.mean, in_words(all.mean_interval), all.sd});
            out.lifts.rows.push_back({title, group, std::string(figure),
                                      static_cast<double>(all.count), all.mean, all.sd,
                                      all.mean_interval.low, all.mean_interval.high});
        }
    }
    out.page.text(fmt::format("{} lifts, {} of them complete.", lifts, complete));
    out.page.table(table, "Over people, of each person's median. " + origin);
}

std::array<Table*, 4> tables_of(PopulationPage& page) {
    return {&page.people, &page.adaptation, &page.thresholds, &page.lifts};
}

void set_columns(PopulationPage& out) {
    out.people.columns = {{"experiment", "title"}, {"ppid", "participant"}, {"round", ""}};
    const std::vector<Table::Column> landmarks = landmark_columns();
    out.people.columns.insert(out.people.columns.end(), landmarks.begin(), landmarks.end());
    out.people.columns.insert(out.people.columns.end(), {{"A_fast", "two-rate model, fitted"},
                                                         {"B_fast", ""},
                                                         {"A_slow", ""},
                                                         {"B_slow", ""},
                                                         {"two_rate_sd", "of the residuals"},
                                                         {"A", "single-rate model, fitted"},
                                                         {"B", ""},
                                                         {"note", "what is not measured"},
                                                         {"session", "folder"}});
    out.adaptation.columns = {{"experiment", ""}, {"round", ""}, {"unit", "of the means"},
                              {"trial", ""},      {"block", ""}, {"people", ""},
                              {"mean", ""},       {"sd", ""},    {"mean_low", "95 %"},
                              {"mean_high", ""}};
    out.thresholds.columns = {
        {"experiment", ""},   {"ppid", "participant"}, {"procedure", ""},
        {"perturbation", ""}, {"trials", "answers"},   {"threshold_share", "of the perturbation"},
        {"shape", ""},        {"lapse", ""},           {"note", "why there is no fit, or more"},
        {"session", "folder"}};
    out.lifts.columns = {{"experiment", ""},   {"trials", ""},   {"figure", ""},
                         {"people", ""},       {"mean", ""},     {"sd", ""},
                         {"mean_low", "95 %"}, {"mean_high", ""}};
}

/// Adds the sessions of one experiment and one kind of people.
void add_group(PopulationPage& out, const std::string& title, const std::string& who,
               const Sessions& sessions, const std::string& folder) {
    const std::string origin = origin_of(sessions, folder);
    std::vector<size_t> first;
    for (const Table* table : tables_of(out)) first.push_back(table->rows.size());
    const std::string& population = sessions.front()->info.moved_by.population;
    out.page.heading(population.empty() ? title : title + ": " + population);
    std::set<std::string> people;
    for (const SessionData* session : sessions) people.insert(session->participant());
    const std::string of =
        people.size() == 1 ? "one participant" : fmt::format("{} participants", people.size());
    out.page.text(fmt::format("{} {} of {}: {}.", who,
                              counted(static_cast<int64_t>(sessions.size()), "session"), of,
                              fmt::join(people, ", ")));
    if (sessions.size() > people.size()) {
        out.page.text(
            "Several sessions are of the same participant: each counts as a person in the means "
            "below, whose intervals are too narrow for that. Take one session of each, or means "
            "of each participant from population-people.csv.");
    }
    add_not_measured(out, title, sessions);
    add_adaptation(out, title, sessions, origin);
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
    set_columns(out);
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
