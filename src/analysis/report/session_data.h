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
    std::vector<Problem> changed = {};  ///< warnings of changes in its files since it ended
    Unmeasured unmeasured = {};  ///< perturbations in the trials whose learning has no measure

    /// The perturbations in `unmeasured`, e.g. "sideways is a mass that differs by direction";
    /// empty if all are measured.
    std::string not_measured() const;
    /// Throws Error when `path` is not a session, or when the session has not ended.
    static SessionData read(const std::string& path);

    /// Whether the session ended before its trials were done; such a session is left out of means
    /// over people.
    bool is_cut_short() const;

    /// Whether a simulated person stood in for a study's participant, in the participant's folder
    /// (`run --simulate`); such a session does not belong to the study.
    bool stands_in() const;

    std::string participant() const {
        return info.participant.id.empty() ? "?" : info.participant.id;
    }
};

/// Folders of the sessions in a folder, at any depth, sorted by name.
std::vector<std::string> find_sessions(const std::string& folder);

/// For each row of lifts.csv, the demands of its trial: "round, block, kind, condition", as far as
/// the trial has them.
std::vector<std::string> groups_of_lifts(const SessionData& session);

}  // namespace dihaptic::analysis
