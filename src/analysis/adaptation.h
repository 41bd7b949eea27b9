// Computes adaptation from a session's trials.csv: how much of a perturbation each reach
// compensated for, and models of this compensation.
//
// With the handle at angle a from the target's direction, and shown at angle s, the perturbation is
// f = s - a and the compensation x = -a: the error e = f - x is visible, except in an error clamp.
// Extents are treated in the same way, as logarithms: if the handle moved by h, was shown to move
// by s, and should have moved by w, f = ln(s / h), x = ln(w / h), in percent (approximately, for
// changes; a doubling is 69 %).
//
// Force fields are measured in channels, by the adaptation index (docs/measures-of-behaviour.md): x
// is the index and f the share of the field, both in percent. The hand's angle is not informative
// in a channel, which holds it at zero, whatever was learned.
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

/// The last attempt at each trial, by trial number. Only this attempt is used: earlier ones had to
/// be repeated.
std::map<int, int> last_attempts(const rows::TrialFile& trials);

/// The trials of one round of the task, or all trials of a task without rounds.
struct AdaptationCurve {
    struct Trial {
        int number = 0;  ///< number in the session, from 1
        std::string block;
        rows::TrialKind kind = rows::TrialKind::baseline;
        double perturbation = 0;  ///< f; 0 in a clamp
        bool clamp = false;       ///< whether the person saw no error
        double compensation = 0;  ///< x; NaN where it was not measured
        /// Name of a perturbation in the trial whose learning has no measure; perturbation and
        /// compensation are then NaN. Empty if there was none.
        std::string under;
    };

    std::string round;  ///< name of the round, and the condition of a curve of errors; or empty
    std::string unit = "deg";  ///< unit of f and x; "%" for extents and indices
    /// angle, extent, kAdaptationIndex, or a column of errors (analysis/error_scale.h)
    std::string measure = "angle";
    std::optional<ErrorScale> errors = {};  ///< for a curve of errors only
    std::vector<Trial> trials;

    /// Whether only those trials that have channels show the learning.
    bool in_channels() const;

    /// Consecutive trials of one block.
    struct Stretch {
        std::string block;
        double perturbation = 0;           ///< largest in magnitude among its perturbed trials
        bool clamp = false;                ///< whether all of its trials are clamps
        std::vector<double> compensation;  ///< measured values, without catch trials
        std::vector<Trial> trials;
    };
    std::vector<Stretch> stretches() const;
    double perturbation() const;  ///< largest in magnitude
    std::vector<double> compensation() const;
    std::vector<model::AdaptationTrial> schedule() const;
    /// A mean over some trials, with its 95 % interval (Student's t, from the spread of these
    /// trials).
    struct Window {
        double mean = kUnmeasured;
        double low = kUnmeasured;
        double high = kUnmeasured;
        int trials = 0;

        void list(FigureLister& row, const std::string& name, const char* what) const;
    };
    /// Means of one block's measured trials.
    struct Block {
        std::string name;
        Window first, last;      ///< at most eight trials, without catch trials or inserted clamps
        Window catch_trials;     ///< all catch trials
        Window inserted_clamps;  ///< all clamps, in a block that also has other trials
    };
    std::vector<Block> blocks() const;

    /// The means that papers report, described by list_landmarks(); empty if there are no such
    /// trials. Savings and rebound are positive in the direction that was learned first.
    struct Windows {
        Window baseline, early, late, catch_trials, clamp_first, clamp_last, washout_first, savings,
            rebound;
    };
    Windows windows() const;
    /// The reason why learning is not measured, or only in part; empty if it is measured.
    std::string note() const;
    /// The reason why the first perturbed block has no means if its perturbations have both signs:
    /// they would average opposite learning. Empty if all have the same sign.
    std::string mixed() const;
    /// Lists the unit, the perturbation, and the windows with their intervals.
    void list_landmarks(FigureLister& row) const;
};

/// Columns of the measure whose first column has this name (task/plan/measures.h).
inline constexpr const char* kAdaptationIndex = "adaptation_index";
inline constexpr const char* kFieldShare = "field_share";
/// Whether an adaptation index was measured in any of the trials of trials.csv.
bool has_adaptation_index(const rows::TrialFile& trials);

/// Table with a row for each of blocks().
Table block_table(const std::vector<AdaptationCurve>& curves);

/// The curves by round, in the order of the rounds. Empty if no reach was measured.
std::vector<AdaptationCurve> adaptation_curves(const rows::TrialFile& trials,
                                               const Unmeasured& unmeasured = {});
/// Curves of the errors in that column of trials.csv, by round and condition, in percent of the
/// perturbation.
std::vector<AdaptationCurve> error_curves(const rows::TrialFile& trials, const std::string& column);

/// Both models, fitted to the curve minus its baseline's mean.
struct AdaptationFits {
    SingleRateFit single_rate;
    TwoRateFit two_rate;
    double bias = 0;  ///< the baseline's mean, which was subtracted
};
/// Returns nullopt when too few trials were measured or none was perturbed.
std::optional<AdaptationFits> fit_adaptation(const AdaptationCurve& curve);

/// A parameter of one of the models.
struct FittedParameter {
    const char* name;
    const char* what;
    double value = kUnmeasured;
    std::optional<std::string> interval = {};  ///< 95 % interval, as text
};
/// The two-rate model's four parameters, then the single-rate model's two; without fits, these have
/// no values.
std::vector<FittedParameter> parameters(const std::optional<AdaptationFits>& fits);
/// Lists the parameters; `in_full`: with the two-rate model's intervals, and the single-rate
/// model's residuals.
void list_fits(FigureLister& row, const std::optional<AdaptationFits>& fits, bool in_full);

}  // namespace dihaptic::analysis
