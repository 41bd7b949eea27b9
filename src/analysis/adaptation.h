// Computes adaptation from a session's trials.csv: how much of a perturbation each reach
// compensated for, and models of this compensation.
//
// If the handle is at angle a from the target's direction but is shown at angle s, the perturbation
// is f = s - a and the compensation is x = -a. The error e = f - x is visible, except in an error
// clamp. Extents are treated in the same way, but as logarithms: if the handle moved by h, was
// shown to move by s, and should have moved by w, then f = ln(s / h) and x = ln(w / h). Both are
// given in percent, which is approximately the relative change (but a doubling is 69 %).
//
// Learning of force fields is measured in channels, by the adaptation index
// (docs/measures-of-behaviour.md): x is the index and f is the fraction of the field that acts,
// both in percent. The hand's angle is not informative in a channel, because the channel holds the
// angle at zero, whatever was learned.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/error_scale.h"
#include "analysis/fits/two_rate_fit.h"
#include "analysis/perturbations.h"
#include "base/figure.h"
#include "rows/trial_row.h"

namespace dihaptic::analysis {

/// The last attempt at each trial, indexed by trial number. Only the last attempt is used: any
/// earlier attempts had to be repeated.
std::map<int, int> last_attempts(const rows::TrialFile& trials);

/// The trials of one round of the task, or all trials of a task without rounds.
struct AdaptationCurve {
    struct Trial {
        int number = 0;  ///< trial number in the session, from 1
        std::string block;
        rows::TrialKind kind = rows::TrialKind::baseline;
        double perturbation = 0;  ///< f; 0 in a clamp trial
        bool clamp = false;       ///< whether the person saw no error
        double compensation = 0;  ///< x; NaN if it was not measured
        /// Name of a perturbation in the trial for which learning has no measure; `perturbation`
        /// and `compensation` are then NaN. Empty if there is no such perturbation.
        std::string under;
    };

    std::string round;         ///< name of the round; for a curve of errors, also the condition
    std::string unit = "deg";  ///< unit of f and x; "%" for extents and indices
    /// "angle", "extent", kAdaptationIndex, or the name of an error column (analysis/error_scale.h)
    std::string measure = "angle";
    std::optional<ErrorScale> errors = {};  ///< set only for a curve of errors
    std::vector<Trial> trials;

    /// Whether learning is visible only in the channel trials of this curve.
    bool in_channels() const;

    /// Consecutive trials of one block.
    struct Stretch {
        std::string block;
        double perturbation = 0;  ///< largest magnitude in the perturbed trials, with its sign
        bool clamp = false;       ///< whether all the trials are clamps
        std::vector<double> compensation;  ///< measured values, excluding catch trials
        std::vector<Trial> trials;
    };
    std::vector<Stretch> stretches() const;
    double perturbation() const;  ///< The perturbation that is largest in magnitude.
    std::vector<double> compensation() const;
    std::vector<model::AdaptationTrial> schedule() const;
    /// A mean over some trials, with its 95 % confidence interval (Student's t, from the spread of
    /// these trials).
    struct Window {
        double mean = kUnmeasured;
        double low = kUnmeasured;
        double high = kUnmeasured;
        int trials = 0;

        void list(FigureLister& row, const std::string& name, const char* what) const;
    };
    /// Means over the measured trials of one block.
    struct Block {
        std::string name;
        Window first, last;   ///< at most eight trials, excluding catch trials and inserted clamps
        Window catch_trials;  ///< mean of all catch trials
        Window inserted_clamps;  ///< mean of all clamps, in a block that also has other trials
    };
    std::vector<Block> blocks() const;

    /// The means that are usually published, as described by list_landmarks(). A mean is empty if
    /// there are no trials for it. Savings and rebound are positive in the direction that was
    /// learned first.
    struct Windows {
        Window baseline, early, late, catch_trials, clamp_first, clamp_last, washout_first, savings,
            rebound;
    };
    Windows windows() const;
    /// The reason why learning is not measured, or is measured only in part. Empty if learning is
    /// fully measured.
    std::string note() const;
    /// The reason why the first perturbed block has no means, if its perturbations have both signs:
    /// the means would average opposite learning. Empty if all perturbations have the same sign.
    std::string mixed() const;
    /// Lists the unit, the perturbation, and the windows with their confidence intervals.
    void list_landmarks(FigureLister& row) const;
};

/// Name of the first column of the adaptation index's columns (task/plan/measures.h).
inline constexpr const char* kAdaptationIndex = "adaptation_index";
inline constexpr const char* kFieldShare = "field_share";
/// Whether an adaptation index was measured in any of the trials of trials.csv.
bool has_adaptation_index(const rows::TrialFile& trials);

/// Returns a table with a row for each of the curves' blocks().
Table block_table(const std::vector<AdaptationCurve>& curves);

/// Returns one curve per round, in the order of the rounds. Empty if no reach was measured.
std::vector<AdaptationCurve> adaptation_curves(const rows::TrialFile& trials,
                                               const Unmeasured& unmeasured = {});
/// Returns curves of the errors in `column` of trials.csv, one per round and condition, in percent
/// of the perturbation.
std::vector<AdaptationCurve> error_curves(const rows::TrialFile& trials, const std::string& column);

/// Fits of both models to the curve after the mean of its baseline has been subtracted.
struct AdaptationFits {
    SingleRateFit single_rate;
    TwoRateFit two_rate;
    double bias = 0;  ///< mean of the baseline, which was subtracted
};
/// Returns nullopt when too few trials were measured or no trial was perturbed.
std::optional<AdaptationFits> fit_adaptation(const AdaptationCurve& curve);

/// A parameter of one of the models.
struct FittedParameter {
    const char* name;
    const char* what;
    double value = kUnmeasured;
    std::optional<std::string> interval = {};  ///< 95 % confidence interval, as text
};
/// Returns the four parameters of the two-rate model, then the two of the single-rate model.
/// Without fits, the parameters have no values.
std::vector<FittedParameter> parameters(const std::optional<AdaptationFits>& fits);
/// Lists the parameters. If `in_full`, also lists the confidence intervals of the two-rate model
/// and the residuals of the single-rate model.
void list_fits(FigureLister& row, const std::optional<AdaptationFits>& fits, bool in_full);

}  // namespace dihaptic::analysis
