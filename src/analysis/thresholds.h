// Thresholds, told from a session's trials.csv and procedures.csv: for each adaptive procedure what
// was shown and said, and the psychometric function that makes the answers most likely.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/fits/psychometric_fit.h"
#include "base/table.h"

namespace dihaptic::analysis {

struct ThresholdTrack {
    std::string procedure;
    std::string kind;  ///< staircase, quest, quest_plus
    std::string perturbation;
    bool logarithmic = false;       ///< levels are log10 of shares
    std::vector<Answer> answers;    ///< in their order
    std::vector<int> trials;        ///< of each, its number in the session
    PsychometricFitSettings model;  ///< that is fitted

    double share(double level) const;  ///< of the perturbation
};

/// By procedure. Answers that are neither yes nor no, and trials of none, are left out.
std::vector<ThresholdTrack> threshold_tracks(const CsvFile& trials, const CsvFile& procedures);

/// The fit of a track, or why there is none.
struct ThresholdFit {
    std::optional<PsychometricFit> fit;
    /// What is to be known of it: why there is none, or that its threshold lies outside of the
    /// levels that were shown, where nobody was asked. Empty: nothing.
    std::string note;
    bool outside = false;
};
/// None of less than ten answers, of one level, or of levels that the sigmoid cannot take.
ThresholdFit fit_threshold(const ThresholdTrack& track);
/// Of its fit, from 500 bootstrap samples.
PsychometricIntervals threshold_intervals(const ThresholdTrack& track, const PsychometricFit& fit,
                                          uint64_t seed);

}  // namespace dihaptic::analysis
