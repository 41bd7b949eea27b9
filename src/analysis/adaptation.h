// Adaptation, told from a session's trials.csv: what of a perturbation was compensated for in each
// reach, and the models that describe it.
//
// With the handle at angle a from the target's direction, and shown at angle s, the perturbation is
// f = s - a and the compensation x = -a: the error e = f - x is what is seen. In an error clamp it
// is not. Of extents the same holds in logarithms: with the handle gone h, shown to have gone s,
// and w wanted, f = ln(s / h), x = ln(w / h), in percent (of small changes; a doubling is 69 %).
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/fits/two_rate_fit.h"
#include "analysis/perturbations.h"
#include "base/table.h"

namespace dihaptic::analysis {

/// One stretch of trials under one kind of perturbation: a round of the task, or all of it.
struct AdaptationCurve {
    struct Trial {
        int number = 0;  ///< in the session, from 1
        std::string block;
        std::string kind;         ///< of the trial, as in trials.csv
        double perturbation = 0;  ///< f 0 in a clamp
        bool clamp = false;       ///< no error was seen
        double compensation = 0;  ///< x; NaN where it was not measured
        /// What it was under that nothing measures: perturbation and compensation are NaN. Empty:
        /// nothing of the kind.
        std::string under;
    };

    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    std::string round;         ///< its name; empty without rounds
    std::string unit = "deg";  ///< of f and x; "%" of extents
    std::vector<Trial> trials;

    /// Trials of one block that followed one another.
    struct Stretch {
        std::string block;
        double perturbation = 0;           ///< of its perturbed trials, the largest by size
        bool clamp = false;                ///< all of it
        std::vector<double> compensation;  ///< as far as measured, without catch trials
        std::vector<Trial> trials;
    };
    std::vector<Stretch> stretches() const;
    double perturbation() const;  ///< largest by size
    std::vector<double> compensation() const;
    std::vector<model::AdaptationTrial> schedule() const;
    /// A mean over some trials, with its 95 % interval (Student's, of the spread of these trials).
    struct Window {
        double mean = kNone;
        double low = kNone;
        double high = kNone;
        int trials = 0;
    };
    /// What was measured of one block, in windows of at most eight trials.
    struct Block {
        std::string name;
        Window first, last;      ///< eight, without catch trials and clamps that were put in
        Window catch_trials;     ///< all of them
        Window inserted_clamps;  ///< all of them, in a block that has other trials, too
    };
    std::vector<Block> blocks() const;

    /// What papers name, each of trials of one block; empty where there are none:
    ///
    /// baseline       all baseline trials before the first perturbed block
    /// early          the first eight trials of the first perturbed block
    /// late           the last eight of the last block that follows it with the same perturbation
    /// catch          all catch trials from the first of these blocks to the last
    /// clamp          the first and the last eight of the first later block that is a clamp
    /// washout_first  the first eight of the first later washout block
    ///
    /// And, toward what was learned first:
    ///
    /// savings   the first eight trials of the first later block with the same perturbation, less
    ///           those of the block that had it first
    /// rebound   the last eight trials of a clamp that follows a block with the opposite
    ///           perturbation, less that block's last two: what was learned first comes back
    struct Windows {
        Window baseline, early, late, catch_trials, clamp_first, clamp_last, washout_first, savings,
            rebound;
    };
    Windows windows() const;
    /// Why what was learned is not measured, or only of a part; empty: it is.
    std::string note() const;
    /// The perturbation and the windows, for a table with landmark_columns().
    std::vector<Table::Cell> landmark_cells() const;
};

std::vector<Table::Column> landmark_columns();

/// The table of blocks(): a row each.
Table block_table(const std::vector<AdaptationCurve>& curves);

/// By round, in the order in which they were done. Empty where no reaches were measured.
std::vector<AdaptationCurve> adaptation_curves(const CsvFile& trials,
                                               const Unmeasured& unmeasured = {});

/// Both models, fitted to the curve less its baseline's mean; none where too little was measured,
/// or nothing perturbed.
struct AdaptationFits {
    SingleRateFit single_rate;
    TwoRateFit two_rate;
    double bias = 0;  ///< the baseline's mean, which was taken off
};
std::optional<AdaptationFits> fit_adaptation(const AdaptationCurve& curve);

}  // namespace dihaptic::analysis
