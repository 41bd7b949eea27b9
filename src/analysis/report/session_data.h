// The tables of a session that a report is made from.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/adaptation.h"
#include "analysis/generalisation.h"
#include "analysis/thresholds.h"
#include "base/table.h"
#include "recording/session.h"

namespace dihaptic::analysis {

struct SessionData {
    recording::SessionFolder folder;
    recording::SessionInfo info;
    task::Task task;  ///< frozen
    CsvFile trials;
    std::optional<CsvFile> lifts;
    std::vector<AdaptationCurve> curves;
    std::vector<ThresholdTrack> tracks;
    std::vector<Generalisation> generalisation;
    std::vector<Problem> changed = {};  ///< of its files, since it ended: warnings
    Unmeasured unmeasured = {};  ///< perturbations in the trials whose learning has no measure

    /// The perturbations in `unmeasured`, e.g. "sideways is a mass that differs by direction";
    /// empty if all are measured.
    std::string not_measured() const;
    /// Throws Error when `path` is no session, or the session has not ended.
    static SessionData read(const std::string& path);

    /// Whether the session ended before its trials were done: means over people leave it out.
    bool is_cut_short() const;

    std::string participant() const {
        return info.participant.id.empty() ? "?" : info.participant.id;
    }
};

/// Folders of the sessions in a folder, at any depth, sorted by name.
std::vector<std::string> find_sessions(const std::string& folder);

/// A lift of a session, and what was asked for in its trial.
struct LiftRow {
    std::string group;  ///< "round, block, kind, condition", as far as the trial has them
    size_t row = 0;     ///< row of lifts.csv
};
std::vector<LiftRow> lift_rows(const SessionData& session);
/// Columns of lifts.csv whose medians reports give.
inline constexpr const char* kLiftFigures[] = {
    "preload_s",     "loading_s",     "peak_grip_rate_N_s", "peak_load_rate_N_s",
    "peak_grip_N",   "static_grip_N", "static_load_N",      "static_ratio",
    "safety_margin", "grip_load_r",   "grip_load_lag_s",    "overshoot_mm"};

/// How a lift depends on the weight of the last one (Johansson and Westling 1988): the regression
///
///     rate = a + b W + c W_before
///
/// of the largest rate of load force before lift-off on the weights that were held, over
/// consecutive complete lifts.
struct PreviousWeight {
    double share = 0;   ///< c / (b + c): 0 if only this weight counts, 1 if only the last one does
    double effect = 0;  ///< c [1/s]
    double error = 0;   ///< its standard error [1/s]
    int lifts = 0;
};
/// Nullopt if weights did not vary by 5 %, or if fewer than ten pairs are complete.
std::optional<PreviousWeight> previous_weight(const CsvFile& lifts);

}  // namespace dihaptic::analysis
