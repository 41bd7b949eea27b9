// Computes thresholds from a session's trials.csv and procedures.csv. For each procedure, finds the
// levels and answers, and the psychometric function that makes the answers most likely.
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
    std::string kind;  ///< staircase, quest, quest_plus or constant
    std::string perturbation;
    std::string number;  ///< name of the number that the procedure chooses; empty if it chooses the
                         ///< perturbation's share
    double standard = 0;            ///< standard value of the number; NaN if there is none
    int down_after = 1;             ///< consecutive answers of yes that lower a staircase's level
    int skipped_reversals = 0;      ///< initial reversals, which are excluded from the mean
    bool logarithmic = false;       ///< whether levels are log10 of the share or number
    std::vector<Answer> answers;    ///< answers, in order
    std::vector<int> trials;        ///< trial number in the session, for each answer
    PsychometricFitSettings model;  ///< settings of the model that is fitted

    /// Returns the share or number for a level, in the unit that the number's name states.
    double share(double level) const;
    std::string what() const;  ///< describes the number that the procedure chooses
    /// The levels after which a staircase changed its direction, as shares or numbers, without the
    /// skipped reversals. Empty for other procedures.
    std::vector<double> reversals() const;
    /// The Weber fraction of a fitted function: the just noticeable difference divided by the
    /// standard; NaN without a standard. With a guess rate of 0.25 or more, the just noticeable
    /// difference is the distance between the threshold and the standard. Otherwise it is half the
    /// distance between the quartiles of the function, since the threshold is then the point of
    /// subjective equality.
    double weber_fraction(const model::Psychometric& function) const;
};

/// Returns one track per procedure. If several procedures with the same model chose the same
/// number, or the share of the same perturbation, a track with all of their answers follows.
/// Answers that are neither yes nor no, and trials without a procedure, are left out.
std::vector<ThresholdTrack> threshold_tracks(const rows::TrialFile& trials,
                                             const rows::ProcedureFile& procedures);

/// Adds the usual psychophysical figures of a fitted function and of a staircase to a table row.
void list_psychophysics(const ThresholdTrack& track, const model::Psychometric& function,
                        FigureLister& row);

/// The fit of a track, or the reason why there is no fit.
struct ThresholdFit {
    std::optional<PsychometricFit> fit;
    /// The reason why there is no fit, or why its threshold is a guess: because it lies outside the
    /// range of levels shown, or because the answers do not rise with the level. Otherwise empty.
    std::string note;

    /// The fitted function; if there is no fit, its parameters are NaN.
    model::Psychometric function() const;
};
/// Fits a track. There is no fit if there are fewer than ten answers, if there is only one level,
/// or if the sigmoid is undefined at some of the levels.
ThresholdFit fit_threshold(const ThresholdTrack& track);
PsychometricIntervals threshold_intervals(const ThresholdTrack& track, const PsychometricFit& fit);
/// The goodness of fit (see fits/psychometric_fit.h), from 500 resamples.
double deviance_share(const ThresholdTrack& track, const PsychometricFit& fit, uint64_t seed);

}  // namespace dihaptic::analysis
