// What a report knows of a session: its tables.
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
    CsvFile trials;
    std::optional<CsvFile> lifts;
    std::vector<AdaptationCurve> curves;
    std::vector<ThresholdTrack> tracks;
    std::vector<Generalisation> generalisation;
    Unmeasured unmeasured;  ///< perturbations that trials were under

    /// "sideways is a mass that differs by direction", ...: what no figure of this session tells
    /// the learning of. Empty: all is measured.
    std::string not_measured() const;
    /// Throws Error when it is no session, or has not ended.
    static SessionData read(const std::string& path);

    /// The session ended before its trials were done: means over people are not for it.
    bool is_cut_short() const;

    std::string participant() const {
        return info.participant.id.empty() ? "?" : info.participant.id;
    }
};

/// Folders of sessions in a folder, at any depth, by name.
std::vector<std::string> find_sessions(const std::string& folder);

/// A session's lifts, each with what was asked for: block, kind, condition, perturbation.
struct LiftRow {
    std::string group;  ///< "block, kind, condition", as far as the trial has them
    size_t row = 0;     ///< of lifts.csv
};
std::vector<LiftRow> lift_rows(const SessionData& session);

/// How a lift depends on the weight of the last one (Johansson and Westling 1988): the regression
///
///     rate = a + b W + c W_before
///
/// of the largest rate of load force before lift-off on the weights that were held, over complete
/// lifts that followed one another.
struct PreviousWeight {
    double share = 0;   ///< c / (b + c): 0 where only this weight counts, 1 where the last one does
    double effect = 0;  ///< c [1/s]
    double error = 0;   ///< its standard error [1/s]
    int lifts = 0;
};
/// None where weights did not vary by 5 %, or less than ten pairs are complete.
std::optional<PreviousWeight> previous_weight(const CsvFile& lifts);

}  // namespace dihaptic::analysis
