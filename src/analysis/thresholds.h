// Computes thresholds from a session's trials.csv and procedures.csv: for each procedure
// the levels and answers, and the psychometric function that makes the answers most likely.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/fits/psychometric_fit.h"
#include "base/figure.h"
#include "rows/procedure_row.h"
#include "rows/trial_row.h"

namespace dihaptic::analysis {

struct ThresholdTrack {
    std::string procedure;
    std::string kind;  ///< staircase, quest, quest_plus, constant
    std::string perturbation;
    std::string number;   ///< name of the number that it chooses; empty: the perturbation's share
    double standard = 0;  ///< standard value of the number; NaN: none
    int skipped_reversals = 0;      ///< initial reversals, which are left out of their mean
    bool logarithmic = false;       ///< levels are log10 of shares, or of the number
    std::vector<Answer> answers;    ///< in order
    std::vector<int> trials;        ///< trial number of each answer in the session
    PsychometricFitSettings model;  ///< model that is fitted

    /// The share at a level, or the number, in the unit that its name states.
    double share(double level) const;
    std::string what() const;  ///< description of the number that the procedure chooses
    /// The levels of a staircase at which its direction changed, without the skipped ones, as
    /// shares or numbers; none for other procedures.
    std::vector<double> reversals() const;
    /// The Weber fraction of a fitted function: the just noticeable difference over the standard;
    /// NaN without a standard. With a guess rate of 0.25 or more that is the threshold's distance
    /// from the standard; otherwise half the distance between the function's quartiles, since its
    /// threshold is the point of subjective equality.
    double weber_fraction(const model::Psychometric& function) const;
};

/// One track per procedure; then one for each number, or share of a perturbation, that several
/// procedures of one model chose, with all of their answers. Answers that are neither yes nor no,
/// and trials without a procedure, are left out.
std::vector<ThresholdTrack> threshold_tracks(const rows::TrialFile& trials,
                                             const rows::ProcedureFile& procedures);

/// Adds to a table's row what a psychophysicist reads from a fitted function and from a staircase.
void list_psychophysics(const ThresholdTrack& track, const model::Psychometric& function,
                        FigureLister& row);

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
