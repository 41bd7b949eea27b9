// Reads those tables of a session from which a report is made.
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
    std::vector<Problem> changed = {};  ///< warnings about files changed after the session ended
    Unmeasured unmeasured = {};  ///< perturbations in the trials for which learning has no measure

    /// Describes the perturbations in `unmeasured`, e.g. "sideways is a mass that differs by
    /// direction"; empty if the learning of all perturbations is measured.
    std::string not_measured() const;
    /// Throws Error when `path` is not a session, or when the session has not ended.
    static SessionData read(const std::string& path);

    /// Whether the session ended before its trials were completed. Such a session is excluded from
    /// means over people.
    bool is_cut_short() const;

    /// Whether a simulated person stood in for a participant of a study, in the participant's
    /// folder (`run --simulate`). Such a session does not count as part of the study.
    bool stands_in() const;

    std::string participant() const {
        return info.participant.id.empty() ? "?" : info.participant.id;
    }
};

/// Returns the folders of all sessions in a folder, at any depth, sorted by name.
std::vector<std::string> find_sessions(const std::string& folder);

/// For each row of lifts.csv, returns a description of the trial: "round, block, kind, condition",
/// as far as the trial has them.
std::vector<std::string> groups_of_lifts(const SessionData& session);

}  // namespace dihaptic::analysis
