// Computes thresholds from a session's trials.csv and procedures.csv: for each procedure
// the levels and answers, and the psychometric function that makes the answers most likely.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/fits/psychometric_fit.h"
#include "rows/procedure_row.h"
#include "rows/trial_row.h"

namespace dihaptic::analysis {

struct ThresholdTrack {
    std::string procedure;
    std::string kind;  ///< staircase, quest, quest_plus, constant
    std::string perturbation;
    std::string number;  ///< name of the number that it chooses; empty: the perturbation's share
    bool logarithmic = false;       ///< levels are log10 of shares, or of the number
    std::vector<Answer> answers;    ///< in order
    std::vector<int> trials;        ///< trial number of each answer in the session
    PsychometricFitSettings model;  ///< model that is fitted

    /// The share, or the number in the unit of its name, at a level.
    double share(double level) const;
    std::string what() const;  ///< description of the number that it chooses
};

/// One track per procedure. Answers that are neither yes nor no, and trials without a procedure,
/// are left out.
std::vector<ThresholdTrack> threshold_tracks(const rows::TrialFile& trials,
                                             const rows::ProcedureFile& procedures);

/// The fit of a track, or the reason why there is none.
struct ThresholdFit {
    std::optional<PsychometricFit> fit;
    /// The reason for a missing fit, or a remark that its threshold lies outside the levels shown;
    /// empty if there is no remark.
    std::string note;
    bool outside = false;  ///< the threshold lies outside the levels shown

    /// The fitted function; without a fit its parameters are NaN.
    model::Psychometric function() const;
};
/// There is no fit for fewer than ten answers, for a single level, or for levels for which the
/// sigmoid is undefined.
ThresholdFit fit_threshold(const ThresholdTrack& track);
PsychometricIntervals threshold_intervals(const ThresholdTrack& track, const PsychometricFit& fit);
/// The quality of the fit, from 500 resamples.
double deviance_share(const ThresholdTrack& track, const PsychometricFit& fit, uint64_t seed);

}  // namespace dihaptic::analysis
