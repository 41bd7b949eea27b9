// The tables of a session from which a report is made.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/adaptation.h"
#include "analysis/generalisation.h"
#include "analysis/thresholds.h"
#include "recording/session.h"
#include "rows/lift_row.h"
#include "rows/trial_row.h"

namespace dihaptic::analysis {

struct SessionData {
    recording::SessionFolder folder;
    recording::SessionInfo info;
    task::Task task;  ///< frozen
    rows::TrialFile trials;
    std::optional<rows::LiftFile> lifts;
    std::vector<AdaptationCurve> curves;
    std::vector<ThresholdTrack> tracks;
    std::vector<Generalisation> generalisation;
    std::vector<Problem> changed = {};  ///< changes in its files since it ended: warnings
    Unmeasured unmeasured = {};  ///< perturbations in the trials whose learning has no measure

    /// The perturbations in `unmeasured`, e.g. "sideways is a mass that differs by direction";
    /// empty if all are measured.
    std::string not_measured() const;
    /// Throws Error when `path` is not a session, or when the session has not ended.
    static SessionData read(const std::string& path);

    /// Whether the session ended before its trials were done; such a session is left out of means
    /// over people.
    bool is_cut_short() const;

    std::string participant() const {
        return info.participant.id.empty() ? "?" : info.participant.id;
    }
};

/// Folders of the sessions in a folder, at any depth, sorted by name.
std::vector<std::string> find_sessions(const std::string& folder);

/// For each row of lifts.csv, the demands of its trial: "round, block, kind, condition", as far as
/// the trial has them.
std::vector<std::string> groups_of_lifts(const SessionData& session);
/// Figures of lifts whose medians are in reports.
inline constexpr double rows::LiftRow::*kLiftFigures[] = {
    &rows::LiftRow::preload,        &rows::LiftRow::loading,       &rows::LiftRow::peak_grip_rate,
    &rows::LiftRow::peak_load_rate, &rows::LiftRow::peak_grip,     &rows::LiftRow::static_grip,
    &rows::LiftRow::static_load,    &rows::LiftRow::static_ratio,  &rows::LiftRow::safety_margin,
    &rows::LiftRow::grip_load_r,    &rows::LiftRow::grip_load_lag, &rows::LiftRow::overshoot};

/// One figure of each of these lifts, in the unit of its column.
template <class Lifts, class Member>
std::vector<double> values_of(const Lifts& lifts, Member rows::LiftRow::*figure) {
    const double scale = figure_column(figure).scale;
    std::vector<double> out;
    for (const rows::LiftRow& lift : lifts) out.push_back(scale * lift.*figure);
    return out;
}

/// Dependence of a lift on the weight of the previous one (Johansson and Westling 1988): the
/// regression
///
///     rate = a + b W + c W_before
///
/// of the largest rate of load force before lift-off on the weights held, over consecutive complete
/// lifts.
struct PreviousWeight {
    double share =
        0;  ///< c / (b + c): 0 if only this weight counts, 1 if only the previous one does
    double effect = 0;  ///< c [1/s]
    double error = 0;   ///< its standard error [1/s]
    int lifts = 0;
};
/// Nullopt if weights varied by less than 5 %, or if fewer than ten pairs are complete.
std::optional<PreviousWeight> previous_weight(const rows::LiftFile& lifts);

}  // namespace dihaptic::analysis
