#include "analysis/report/session_tables.h"

#include "analysis/report/statistics.h"

namespace dihaptic::analysis {
namespace {

/// Adds a row for each trial of a curve.
void add_curve(Table& table, const AdaptationCurve& curve,
               const std::optional<AdaptationFits>& fits) {
    for (size_t i = 0; i < curve.trials.size(); ++i) {
        const AdaptationCurve::Trial& trial = curve.trials[i];
        const double bias = fits ? fits->bias : 0;
        const double two_rate = fits ? bias + fits->two_rate.predicted[i] : kUnmeasured;
        const double single_rate = fits ? bias + fits->single_rate.predicted[i] : kUnmeasured;
        FigureLister row;
        row("round", curve.round, "", "name");
        row("trial_num", trial.number, "1", "number in the session, from 1");
        row("block", trial.block, "", "name");
        row("kind", trial.kind, "", "kind of the trial");
        row("unit", curve.unit, "", "unit of the values below");
        row("perturbation", trial.perturbation, "1", "perturbation; 0 if no error was seen");
        row("error_seen", std::string(trial.clamp ? "no" : "yes"), "",
            "'no' in clamps, in reaches that fell short, in reaches of which neither the path nor "
            "the end was shown, and if unknown");
        row("compensation", trial.compensation, "1", "compensation of the hand");
        row("two_rate", two_rate, "1", "compensation by the fitted two-rate model");
        row("single_rate", single_rate, "1", "compensation by the fitted single-rate model");
        add_row(table, row);
    }
}

/// Adds a row for a curve.
void add_fits(Table& table, const AdaptationCurve& curve,
              const std::optional<AdaptationFits>& fits) {
    FigureLister row;
    row("round", curve.round, "", "name");
    curve.list_landmarks(row);
    list_fits(row, fits, true);
    row("note", curve.note().empty() ? curve.mixed() : curve.note(), "", "what is not measured");
    add_row(table, row);
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
    row("trials", track.answers.size(), "1", "number of answers");
    row("threshold", f.threshold, "1", "level of the threshold");
    row("threshold_95", threshold_95, "", "its interval, from the profile likelihood");
    row("threshold_share", track.share(f.threshold), "1",
        "share of the perturbation; or the chosen number, in the unit that its name states");
    list_psychophysics(track, f, row);
    row("shape", f.shape, "1", "shape of the sigmoid");
    row("shape_95", shape_95, "", "its interval, from the profile likelihood");
    row("lapse", f.lapse, "1", "share of answers that do not depend on the level");
    row("deviance_share", deviance, "1",
        "share of resamples that fit no better than the data; below 0.05: the function does not "
        "fit");
    row("note", threshold.note, "", "reason for a missing fit, or a remark");
    return row;
}

}  // namespace

FittedSession::FittedSession(SessionData session) : data(std::move(session)) {
    for (const AdaptationCurve& curve : data.curves) adaptation.push_back(fit_adaptation(curve));
    for (const ThresholdTrack& track : data.tracks) thresholds.push_back(fit_threshold(track));
}

SessionTables session_tables(const FittedSession& session) {
    const SessionData& data = session.data;
    SessionTables out;
    for (size_t i = 0; i < data.curves.size(); ++i) {
        add_curve(out.adaptation, data.curves[i], session.adaptation[i]);
        add_fits(out.fits, data.curves[i], session.adaptation[i]);
    }
    if (!data.curves.empty()) out.blocks = block_table(data.curves);
    if (!data.generalisation.empty())
        out.generalisation = figure_table<Generalisation>(data.generalisation);
    for (size_t i = 0; i < data.tracks.size(); ++i)
        add_row(out.thresholds, threshold_row(data, data.tracks[i], session.thresholds[i]));
    return out;
}

}  // namespace dihaptic::analysis
