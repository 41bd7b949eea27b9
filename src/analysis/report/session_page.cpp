#include "analysis/report/session_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "analysis/lifts.h"
#include "analysis/report/course.h"
#include "analysis/report/lift_curves.h"
#include "analysis/report/measure_section.h"
#include "analysis/report/methods_text.h"
#include "analysis/report/reach_paths.h"
#include "analysis/report/statistics.h"
#include "analysis/session_report.h"
#include "base/number.h"
#include "base/palette.h"
#include "base/regular_file.h"
#include "base/text_file.h"
#include "recording/raw_log.h"
#include "rows/correction_row.h"

namespace dihaptic::analysis {
namespace {

constexpr const char* kPeak = "#000000";

/// Facts about the session, for the head of the page.
Table facts(const SessionData& session) {
    const recording::SessionInfo& info = session.info;
    Table table{{{"", ""}, {"", ""}}, {}};
    const auto row = [&](const std::string& name, const std::string& value) {
        if (!value.empty()) table.rows.push_back({name, value});
    };
    const recording::Participant& person = info.participant;
    std::string who = person.id;
    if (!person.age.empty()) who += fmt::format(", {} years", person.age);
    if (!person.sex.empty()) who += ", " + person.sex;
    if (!person.handedness.empty()) who += ", " + person.handedness + "-handed";
    row("participant", who);
    row("hand", info.moved_by.describe());
    row("started", info.started);
    row("state", std::string(enum_name(info.state)));
    row("experiment", info.experiment);
    row("command", info.command);
    row("seed", info.seed);
    for (const recording::DeviceRecord& device : info.devices)
        row("device of " + device.finger, device.model);
    row("end", info.finished);
    if (info.convergence) row("contact", info.convergence->describe());
    for (const std::string& note : info.notes) row("note", note);
    const std::string written = session.folder.file("note.txt");
    try {
        if (std::filesystem::is_symlink(std::filesystem::symlink_status(written))) {
            row("note by hand", "not shown: note.txt is a link to another file");
        } else if (is_there(written)) {
            row("note by hand", read_text_file(written));
        }
    } catch (const Error& e) {
        row("note by hand", e.what());
    }
    return table;
}

/// Number of attempts with each outcome, by block.
Table outcome_table(const SessionData& session) {
    std::vector<std::string> blocks;
    std::vector<std::string> names;
    std::map<std::pair<std::string, std::string>, int> counts;
    const auto remember = [](std::vector<std::string>& list, const std::string& item) {
        if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
    };
    for (const rows::TrialRow& row : session.trials) {
        const rows::AskedRow& asked = row.asked;
        const std::string block =
            (asked.round.empty() ? "" : asked.round + ", ") +
            (asked.block.empty() ? number_text(asked.block_number) : asked.block);
        const std::string& outcome = row.measures.outcome;
        remember(blocks, block);
        remember(names, outcome);
        ++counts[{block, outcome}];
    }
    Table table;
    table.columns = {{"block", ""}};
    for (const std::string& name : names) table.columns.push_back({name, "attempts"});
    for (const std::string& block : blocks) {
        std::vector<Table::Cell>& row = table.rows.emplace_back();
        row.emplace_back(block);
        for (const std::string& name : names)
            row.emplace_back(static_cast<double>(counts[{block, name}]));
    }
    return table;
}

/// Each curve's windows, with their intervals.
Table windows_of(const SessionData& session) {
    Table table;
    table.columns = {
        {"round", ""}, {"figure", ""}, {"mean", ""}, {"95 %", "over these trials"}, {"of", ""}};
    for (const AdaptationCurve& curve : session.curves) {
        FigureLister list;
        curve.list_landmarks(list);
        // after measure, unit and perturbation, each mean has one column, and its interval two
        for (size_t i = 3; i + 2 < list.cells.size(); i += 3) {
            const auto at = [&](size_t k) { return std::get<double>(list.cells[k]); };
            if (std::isnan(at(i))) continue;
            table.rows.push_back({curve.round, list.columns[i].name, at(i),
                                  in_words({at(i + 1), at(i + 2)}), list.columns[i].description});
        }
    }
    return table;
}

/// The models' parameters, with their intervals.
Table rates_of(const SessionData& session,
               const std::vector<std::optional<AdaptationFits>>& all_fits) {
    Table rates{{{"round", ""}, {"parameter", ""}, {"fitted", ""}, {"95 %", "profile"}}, {}};
    for (size_t c = 0; c < session.curves.size(); ++c) {
        if (!all_fits[c]) continue;
        for (const FittedParameter& p : parameters(all_fits[c]))
            rates.rows.push_back(
                {session.curves[c].round, std::string(p.what), p.value, *p.interval});
    }
    return rates;
}

/// Adds a curve trial by trial: a chart, and rows of the table.
void add_curve(SessionPage& out, const SessionData& session, const AdaptationCurve& curve,
               const std::optional<AdaptationFits>& fits) {
    Series measured{"compensation", Drawn::points, {}, {}, {}, {}, {}};
    Series perturbation{"perturbation", Drawn::steps, {}, {}, {}, {}, {}};
    Series two_rate{"two-rate fit", Drawn::line, {}, {}, {}, {}, {}};
    std::vector<Mark> marks;
    for (size_t i = 0; i < curve.trials.size(); ++i) {
        const AdaptationCurve::Trial& trial = curve.trials[i];
        const auto x = static_cast<double>(i + 1);
        if (i == 0 || trial.block != curve.trials[i - 1].block) marks.push_back({x, trial.block});
        measured.x.push_back(x);
        measured.y.push_back(trial.compensation);
        perturbation.x.push_back(x);
        perturbation.y.push_back(trial.clamp ? kUnmeasured : trial.perturbation);
        const double bias = fits ? fits->bias : 0;
        const double fitted = fits ? bias + fits->two_rate.predicted[i] : kUnmeasured;
        const double single = fits ? bias + fits->single_rate.predicted[i] : kUnmeasured;
        two_rate.x.push_back(x);
        two_rate.y.push_back(fitted);
        FigureLister row;
        row("round", curve.round, "", "name");
        row("trial_num", trial.number, "1", "in the session");
        row("block", trial.block, "", "name");
        row("kind", trial.kind, "", "of the trial");
        row("unit", curve.unit, "", "unit of the values below");
        row("perturbation", trial.perturbation, "1", "0 if no error was seen");
        row("error_seen", std::string(trial.clamp ? "no" : "yes"), "",
            "no in clamps, in reaches that fell short, in those of which neither the way nor the "
            "end was shown, and if unknown");
        row("compensation", trial.compensation, "1", "compensation of the hand");
        row("two_rate", fitted, "1", "fitted");
        row("single_rate", single, "1", "fitted");
        add_row(out.adaptation, row);
    }
    Chart chart;
    chart.title = curve.round.empty() ? "Adaptation" : "Adaptation " + curve.round;
    chart.x_label = "trial";
    chart.y_label = y_label(curve);
    chart.caption = origin_of(session);
    chart.marks = marks;
    chart.series = {perturbation, measured};
    if (fits) chart.series.push_back(two_rate);
    out.page.chart(chart);
}

void add_adaptation(SessionPage& out, const SessionData& session) {
    out.page.heading("Adaptation");
    out.page.text(
        "Compensation is the angle of the hand against the perturbation after the measured "
        "distance, or the logarithm by which its first stroke fell short [%], or, for a force "
        "field, the adaptation index: the force on a channel over the force that would cancel the "
        "field [%]. It is 0 before learning, and equals the perturbation after complete learning. "
        "Models are fitted to it less the baseline's mean, by least squares, with 95 % profile "
        "intervals; the valley of the two-rate model is flat, so compare its curve rather than its "
        "parameters.");
    std::vector<std::optional<AdaptationFits>> all_fits;
    for (const AdaptationCurve& curve : session.curves) {
        const auto& fits = all_fits.emplace_back(fit_adaptation(curve));
        add_curve(out, session, curve, fits);
        if (curve.errors)
            out.page.text(fmt::format(
                "{}: without any learning of the perturbation, {} is {:.4g} more (standard error "
                "{:.2g}) than without the perturbation, {:.4g}. Compensation is the part of this "
                "difference that has disappeared; the intervals of rates treat these figures as "
                "known.",
                curve.round.empty() ? "All trials" : curve.round, curve.measure,
                curve.errors->effect, curve.errors->standard_error, curve.errors->offset));
        FigureLister row;
        row("round", curve.round, "", "name");
        curve.list_landmarks(row);
        list_fits(row, fits, true);
        row("note", curve.note().empty() ? curve.mixed() : curve.note(), "", "unmeasured quantity");
        add_row(out.fits, row);
    }
    if (const Table windows = windows_of(session); !windows.rows.empty())
        out.page.table(windows, "Compensation in windows of one block each. " + origin_of(session));
    if (const Table rates = rates_of(session, all_fits); !rates.rows.empty())
        out.page.table(rates, "Models fitted to the curves. " + origin_of(session));
    out.blocks = block_table(session.curves);
    out.page.folded_table("Compensation by block", out.blocks);
}

void add_generalisation(SessionPage& out, const SessionData& session) {
    out.page.heading("Generalisation");
    out.generalisation = figure_table<Generalisation>(session.generalisation);
    std::map<std::string, Series> rounds;
    for (const Generalisation& g : session.generalisation) {
        Series& series = rounds[g.round];
        series.name = g.round.empty() ? "compensation" : g.round;
        series.drawn = Drawn::points;
        series.x.push_back(g.angle_deg);
        series.y.push_back(g.compensation_deg);
    }
    Chart chart{"Generalisation",
                "angle from the trained direction [deg]",
                "angle [deg]",
                origin_of(session),
                {},
                {}};
    for (const auto& [round, series] : rounds) chart.series.push_back(series);
    out.page.chart(chart);
    out.page.table(
        out.generalisation,
        "Compensation in clamps and catch trials after training began. " + origin_of(session));
}

void add_corrections(Page& page, const SessionData& session) {
    const std::string file = session.folder.file("corrections.csv");
    if (!is_there(file)) return;
    std::vector<rows::CorrectionRow> rows;
    for (const rows::CorrectionRow& row : rows::RowFile<rows::CorrectionRow>(file))
        rows.push_back(row);
    if (rows.empty()) return;
    page.heading("Corrections");
    page.table(figure_table<rows::CorrectionRow>(rows),
               "When the mean velocity parts from that of matched trials. " + origin_of(session));
}

/// Chart of the fitted function, and of the share of yes among the answers at each level.
Chart psychometric_chart(const ThresholdTrack& track, const std::optional<PsychometricFit>& fitted,
                         const std::string& origin) {
    Chart chart;
    chart.title = "Answers of " + track.procedure;
    chart.x_label = track.logarithmic ? "level (log10 of the " + track.what() + ")" : track.what();
    chart.y_label = "share of yes";
    chart.caption = origin;
    Series answers{"answers", Drawn::points, {}, {}, {}, {}, {}};
    const auto counts = count(track.answers);
    for (const LevelCount& c : counts) {
        answers.x.push_back(c.level);
        answers.y.push_back(static_cast<double>(c.yes) / c.trials);
    }
    chart.series.push_back(answers);
    if (!fitted || counts.empty()) return chart;
    constexpr int kSteps = 100;
    Series curve{"fit", Drawn::line, {}, {}, {}, {}, {}};
    for (int i = 0; i <= kSteps; ++i) {
        const double x =
            counts.front().level + (counts.back().level - counts.front().level) * i / kSteps;
        curve.x.push_back(x);
        curve.y.push_back(fitted->function.probability(x));
    }
    chart.series.push_back(curve);
    chart.marks.push_back({fitted->function.threshold, "threshold"});
    return chart;
}

FigureLister threshold_row(const SessionData& session, const ThresholdTrack& track,
                           const ThresholdFit& threshold) {
    const model::Psychometric f = threshold.function();
    std::optional<std::string> threshold_95, shape_95;
    double deviance = kUnmeasured;
    if (threshold.fit) {
        const PsychometricIntervals intervals = threshold_intervals(track, *threshold.fit);
        threshold_95 = in_words(intervals.threshold);
        shape_95 = in_words(intervals.shape);
        deviance = deviance_share(track, *threshold.fit, session.folder.seed_of(session.info));
    }
    FigureLister row;
    row("procedure", track.procedure, "", "name");
    row("kind", track.kind, "", "staircase, quest, quest_plus or constant");
    row("perturbation", track.perturbation, "", "name");
    row("chooses", track.what(), "", "quantity of the levels");
    row("trials", track.answers.size(), "1", "answers");
    row("threshold", f.threshold, "1", "level");
    row("threshold_95", threshold_95, "", "its interval, from the profile likelihood");
    row("threshold_share", track.share(f.threshold), "1",
        "share of the perturbation; or the number, in the unit of its name");
    list_psychophysics(track, f, row);
    row("shape", f.shape, "1", "shape of the sigmoid");
    row("shape_95", shape_95, "", "its interval, from the profile likelihood");
    row("lapse", f.lapse, "1", "share of answers that do not depend on the level");
    row("deviance_share", deviance, "1", "below 0.05: the function does not fit");
    row("note", threshold.note, "", "reason for a missing fit, or a remark");
    return row;
}

void add_thresholds(SessionPage& out, const SessionData& session) {
    out.page.heading("Thresholds");
    out.page.text(
        "Each procedure chose the share of its perturbation, or a number, usually by the preceding "
        "answers. The function is fitted to all of its answers by maximum likelihood, with lapses "
        "up to 5 %. A 95 % interval contains the values with which the other parameters, refitted, "
        "make the answers hardly less likely (twice the log likelihood falls by 3.84 at its ends). "
        "The share of the deviance is from 500 bootstrap samples.");
    for (const ThresholdTrack& track : session.tracks) {
        const ThresholdFit threshold = fit_threshold(track);
        const auto& fitted = threshold.fit;
        Series yes{"yes", Drawn::points, {}, {}, {}, {}, {}};
        Series no{"no", Drawn::points, {}, {}, {}, {}, {}};
        for (size_t i = 0; i < track.answers.size(); ++i) {
            Series& series = track.answers[i].yes ? yes : no;
            series.x.push_back(static_cast<double>(i + 1));
            series.y.push_back(track.answers[i].level);
        }
        out.page.chart(
            {"Levels of " + track.procedure, "answer", "level", origin_of(session), {yes, no}, {}});
        out.page.chart(psychometric_chart(track, fitted, origin_of(session)));
        add_row(out.thresholds, threshold_row(session, track, threshold));
    }
    out.page.table(transposed(out.thresholds), origin_of(session));
}

/// Medians of the lifts' figures by group.
Table lift_summary(const SessionData& session) {
    Table table;
    table.columns = {{"trials", "block, kind, condition"}, {"lifts", ""}, {"complete", ""}};
    for (const auto figure : kLiftFigures) table.columns.push_back(figure_column(figure).column);
    table.columns.push_back(figure_column(&rows::LiftRow::slips).column);
    std::vector<std::string> groups;
    std::map<std::string, std::vector<rows::LiftRow>> by_group;
    const std::vector<std::string> group_of = groups_of_lifts(session);
    for (size_t i = 0; i < group_of.size(); ++i) {
        std::vector<rows::LiftRow>& own = by_group[group_of[i]];
        if (own.empty()) groups.push_back(group_of[i]);
        own.push_back((*session.lifts)[i]);
    }
    for (const std::string& group : groups) {
        std::vector<Table::Cell>& row = table.rows.emplace_back();
        const std::vector<rows::LiftRow>& own = by_group[group];
        row = {group.empty() ? "all" : group, static_cast<double>(own.size()),
               static_cast<double>(std::ranges::count_if(own, &rows::LiftRow::complete))};
        for (const auto figure : kLiftFigures)
            row.emplace_back(sample(values_of(own, figure)).median);
        row.emplace_back(sample(values_of(own, &rows::LiftRow::slips)).mean);
    }
    return table;
}

void add_lifts(SessionPage& out, const SessionData& session) {
    const rows::LiftFile& lifts = *session.lifts;
    out.page.heading("Grip and lift");
    out.page.table(transposed(lift_summary(session)),
                   "Medians over attempts; an incomplete lift counts for the figures that it has. "
                   "lifts.csv lists each attempt, with its missing event. " +
                       origin_of(session));
    if (lifts.size() < 3) return;
    const auto curve = [&](const char* name, double rows::LiftRow::*figure,
                           const char* colour = "") {
        Series series{name, Drawn::points, {}, values_of(lifts, figure), {}, {}, colour};
        for (size_t i = 0; i < lifts.size(); ++i) series.x.push_back(static_cast<double>(i + 1));
        return series;
    };
    std::vector<Mark> marks;
    std::string last;
    const std::vector<std::string> groups = groups_of_lifts(session);
    for (size_t i = 0; i < groups.size(); ++i) {
        const std::string block = groups[i].substr(0, groups[i].find(','));
        if (block != last) marks.push_back({static_cast<double>(i + 1), block});
        last = block;
    }
    const auto chart = [&](const char* title, const char* unit, std::vector<Series> series) {
        out.page.chart({title, "lift", unit, origin_of(session), std::move(series), marks});
    };
    chart("Forces in the hold, and the peak of grip", "N",
          {curve("static grip", &rows::LiftRow::static_grip, palette::kGrip),
           curve("static load", &rows::LiftRow::static_load, palette::kLoad),
           curve("peak grip", &rows::LiftRow::peak_grip, kPeak)});
    chart("Largest rates before lift-off", "N/s",
          {curve("grip", &rows::LiftRow::peak_grip_rate, palette::kGrip),
           curve("load", &rows::LiftRow::peak_load_rate, palette::kLoad)});
    chart("Durations", "s",
          {curve("preload", &rows::LiftRow::preload), curve("loading", &rows::LiftRow::loading)});
    if (const auto effect = previous_weight(lifts)) {
        out.page.text(
            fmt::format("Weight of the previous lift: the largest rate of load force increases by "
                        "{:.3g} +- {:.2g} N/s for each N of the previous object's weight ({} pairs "
                        "of lifts), {:.0f} % of the effect of both weights.",
                        effect->effect, effect->error, effect->lifts, 100 * effect->share));
    }
}

/// Adds the content of the log, and its faults: it may have been damaged since the tables were
/// made.
void add_log(SessionPage& out, const SessionData& session,
             const std::function<void(double)>& progress) {
    recording::RawLogReader log(session.folder.raw_log());
    session.folder.check_log(session.info, log.head());
    LiftCurves lifts(session, log.head().tick);
    ReachPaths reaches(session, log.head());
    CourseCharts course(session, log.head());
    while (const frame::Frame* frame = log.next()) {
        if (progress) progress(log.share());
        lifts.see(*frame);
        reaches.see(*frame);
        course.see(*frame);
    }
    lifts.add_to(out.page, origin_of(session));
    reaches.add_to(out.page, origin_of(session));
    course.add_to(out.page, origin_of(session));
    const recording::LogHealth& health = log.read_to_end();
    for (const std::string& what : recording::describe_version(health)) out.page.text(what + ".");
    if (!health.damaged(session.info.ticks)) return;
    out.log = recording::describe(health, session.info.ticks, log.head().planned());
    out.page.heading("The log is incomplete");
    for (const std::string& what : out.log) out.page.text(what + ".");
}

/// Adds methods and results in sentences.
void add_text(SessionPage& out, const SessionData& session) {
    const bool lifted = session.lifts && !session.lifts->empty();
    const MethodsText text =
        methods_text(session, out, windows_of(session), lifted ? lift_summary(session) : Table{});
    out.page.heading("In words");
    out.page.text("A start for a paper's methods and results, with the figures from above.");
    for (const std::string& paragraph : text.methods) out.page.text(paragraph);
    for (const std::string& paragraph : text.results) out.page.text(paragraph);
}

}  // namespace

std::string origin_of(const SessionData& session) {
    return fmt::format("{} {}, {}, seed {}, {}", session.info.moved_by.describe(),
                       session.folder.path(), session.info.program, session.info.seed,
                       session.info.started);
}

SessionPage session_page(const SessionData& session, const std::string& command,
                         const std::function<void(double)>& progress) {
    SessionPage out{Page(session.info.title, session.info.moved_by.describe(),
                         fmt::format("{}. Made by {} with: {}", origin_of(session),
                                     recording::program_version(), command))};
    out.page.table(facts(session), "");
    out.page.problems("Changed since the session ended", session.changed);
    out.page.heading("Trials");
    out.page.table(outcome_table(session), "Attempts at trials by outcome. " + origin_of(session));
    if (const Table all = perturbation_table(session.task); !all.rows.empty())
        out.page.table(
            all, "Perturbations; the column share in trials.csv states how much of each acts. " +
                     origin_of(session));
    if (!session.unmeasured.empty()) {
        out.page.heading("Not measured");
        out.page.text("Dihaptic does not yet measure the learning of these perturbations: " +
                      session.not_measured() +
                      ". Figures of trials under them are empty. The hand's movement is in "
                      "trials.csv, and in full in session.nwb.");
    }
    add_measures(out.page, session);
    if (!session.curves.empty()) add_adaptation(out, session);
    if (!session.generalisation.empty()) add_generalisation(out, session);
    add_corrections(out.page, session);
    if (!session.tracks.empty()) add_thresholds(out, session);
    if (session.lifts && !session.lifts->empty()) add_lifts(out, session);
    // a rehearsal has no log
    if (is_there(session.folder.raw_log())) add_log(out, session, progress);
    add_text(out, session);
    out.page.heading("Settings");
    out.page.folded_table("All settings, with their origins", read_settings(session.folder));
    return out;
}

}  // namespace dihaptic::analysis
