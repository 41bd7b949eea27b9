// Procedures (procedures/) as an experiment file describes them. In each trial the share of a
// perturbation, from 0 to 1, or a number of its own that formulas name, follows from the answers so
// far.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "task/file/ref.h"
#include "task/procedures/procedure.h"

namespace dihaptic::task {

/// A level beyond this, in whatever unit, is a slip.
constexpr double kFurthestLevel = 1e6;

struct StaircaseSpec {
    int down_after = 1;
    double start = 1;
    std::vector<double> steps_up;
    double down_over_up = 1;
    std::optional<double> lowest;
    std::optional<double> highest;
    int reversals = 0;  ///< number after which it is done; 0: done after the procedure's trials
    int skipped_reversals = 0;

    template <class Visitor>
    void visit(Visitor& v) {
        v("down_after", down_after,
          Field::number().within(1, 10).says(
              "How many answers of yes in a row take the level down."));
        v("start", start,
          Field::number()
              .within(-kFurthestLevel, kFurthestLevel)
              .required()
              .says("Level that it begins with."));
        v("steps_up", steps_up,
          Field::number()
              .within(1e-6, kFurthestLevel)
              .required()
              .says("Steps up, each used until the next reversal; the last stays."));
        v("down_over_up", down_over_up,
          Field::number().within(0.01, 100).says("Size of a step down over that of a step up."));
        v("lowest", lowest,
          Field::number()
              .within(-kFurthestLevel, kFurthestLevel)
              .says("Lowest level; left out, that of the share."));
        v("highest", highest,
          Field::number()
              .within(-kFurthestLevel, kFurthestLevel)
              .says("Highest level; left out, that of the share."));
        v("reversals", reversals,
          Field::number().within(0, 1000).says(
              "Number of reversals after which it is done; 0 is after the procedure's trials."));
        v("skipped_reversals", skipped_reversals,
          Field::number().within(0, 1000).says(
              "Number of first reversals that do not count for the threshold."));
    }
};

struct QuestSpec {
    double prior_mean = 0;
    double prior_sd = 1;
    double target = 0.82;
    double slope = 3.5;
    double blind = 0.01;
    double grain = 0.01;
    int cells = 500;
    std::optional<double> lowest;
    std::optional<double> highest;

    template <class Visitor>
    void visit(Visitor& v) {
        v("prior_mean", prior_mean,
          Field::number()
              .within(-kFurthestLevel, kFurthestLevel)
              .required()
              .says("Mean of the threshold's prior distribution."));
        v("prior_sd", prior_sd,
          Field::number()
              .within(1e-6, kFurthestLevel)
              .required()
              .says("Standard deviation of that distribution."));
        v("target", target,
          Field::number().within(0, 1).says("Probability of yes at the threshold."));
        v("slope", slope,
          Field::number().within(1e-3, 1000).says("Slope of the Weibull function."));
        v("blind", blind, Field::number().within(0, 1).says("Share of answers that are lapses."));
        v("grain", grain,
          Field::number().within(1e-6, 10).says("Step of the levels that it computes with."));
        v("cells", cells,
          Field::number().within(2, 10000).says("Number of the levels that it computes with."));
        v("lowest", lowest,
          Field::number().within(-kFurthestLevel, kFurthestLevel).says("No level lies below it."));
        v("highest", highest,
          Field::number().within(-kFurthestLevel, kFurthestLevel).says("No level lies above it."));
    }
};

/// Equally spaced values, both ends included.
struct GridSpec {
    double from = 0;
    double to = 0;
    int count = 1;

    std::vector<double> values() const {
        std::vector<double> out;
        for (int i = 0; i < count; ++i)
            out.push_back(count == 1 ? from : from + (to - from) * i / (count - 1));
        return out;
    }

    template <class Visitor>
    void visit(Visitor& v) {
        v("from", from,
          Field::number().within(-kFurthestLevel, kFurthestLevel).required().says("First value."));
        v("to", to,
          Field::number().within(-kFurthestLevel, kFurthestLevel).required().says("Last value."));
        v("count", count,
          Field::number().within(1, 1000).required().says(
              "Number of equally spaced values, both ends included."));
    }
};

struct QuestPlusSpec {
    GridSpec levels;
    GridSpec thresholds;
    GridSpec shapes;
    GridSpec lapses{0.02, 0.02, 1};

    template <class Visitor>
    void visit(Visitor& v) {
        v("levels", levels, Field::number().required().says("Levels that may be shown."));
        v("thresholds", thresholds,
          Field::number().required().says("Thresholds that are thought possible."));
        v("shapes", shapes,
          Field::number().required().says("Slopes of the function that are thought possible."));
        v("lapses", lapses,
          says("Shares of lapses that are thought possible; left out, 0.02 alone."));
    }
};

/// Levels that are shown whatever is answered: each once in every round, in an order by chance.
struct ConstantSpec {
    std::vector<double> levels;

    template <class Visitor>
    void visit(Visitor& v) {
        v("levels", levels,
          Field::number()
              .within(-kFurthestLevel, kFurthestLevel)
              .required()
              .says("The levels, each of which is shown equally often."));
    }
};

/// What is asked, from which the guess rate follows. yes_no: whether, or which way; it is then as
/// likely as a lapse. 2afc: which of two.
enum class Design { yes_no, two_alternatives };
constexpr auto enum_names(Design) {
    return std::array{"yes_no", "2afc"};
}

struct PerturbationSpec;

struct ProcedureSpec {
    std::string name;
    Refs<PerturbationSpec> perturb;  ///< whose share is the level; with `level`, that act
    std::string level;  ///< name of a number, in whose unit the levels are; empty: a share
    std::optional<double> standard;  ///< its value where no procedure chooses it, in the same unit
    bool logarithmic = false;        ///< the share, or the number, is 10^level
    std::string yes;                 ///< the outcome that grows likelier with the level
    std::string no;
    int trials = 40;  ///< largest number
    std::optional<model::Sigmoid> sigmoid;
    std::optional<Design> design;
    double guess = 0.5;           ///< probability of "yes" far below the threshold
    bool guess_is_lapse = false;  ///< the guess rate is the lapse rate, instead
    std::optional<StaircaseSpec> staircase;
    std::optional<QuestSpec> quest;
    std::optional<QuestPlusSpec> quest_plus;
    std::optional<ConstantSpec> constant;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the procedure."));
        v("perturb", perturb, says("Perturbation whose share is the level; or else level."));
        v("level", level,
          says("Name of the number that it chooses, which formulas may name, with its unit."));
        v("standard", standard,
          Field::number()
              .within(-kFurthestLevel, kFurthestLevel)
              .says("The level's value in the other interval, of two alternatives."));
        v("logarithmic", logarithmic, says("Whether the level is log10 of the share."));
        v("yes", yes, says("Outcome that becomes likelier with the level."));
        v("no", no, says("The other outcome."));
        v("trials", trials, Field::number().within(1, 1000).says("Largest number of trials."));
        v("sigmoid", sigmoid,
          says("Psychometric function of the fit: normal, but for quest that of the "
               "procedure, weibull_log10 with its slope."));
        v("design", design, says("What is asked in a trial; guess follows from it."));
        visit_guess(v);
        v("staircase", staircase, says("A staircase chooses the level."));
        v("quest", quest, says("QUEST chooses it."));
        v("quest_plus", quest_plus, says("QUEST+ chooses it."));
        v("constant", constant, says("Constant stimuli: each level equally often."));
        if constexpr (requires { v.place(); }) place = v.place();
    }

    /// Levels that it may propose lie from least to most: infinite where it does not say.
    double most() const;
    double least() const;
    /// The share, or the number in the unit of its name.
    double share(double at) const;
    /// Function that is fitted to the answers.
    model::Sigmoid fitted() const {
        return sigmoid.value_or(quest ? model::Sigmoid::weibull_log10 : model::Sigmoid::normal);
    }
    /// Its shape, if the procedure takes it as known: its answers then do not tell.
    std::optional<double> known_shape() const {
        if (quest && fitted() == model::Sigmoid::weibull_log10) return quest->slope;
        return std::nullopt;
    }
    /// The procedure's key in the file.
    const char* kind() const;

  private:
    template <class Visitor>
    void visit_guess(Visitor& v) {
        const Field rate = Field::number().within(0, 1);
        if (!design) {
            v("guess", guess, rate.says("Probability of yes far below the threshold."));
            v("guess_is_lapse", guess_is_lapse,
              says("Whether that probability is the share of lapses."));
            return;
        }
        guess = *design == Design::two_alternatives ? 0.5 : 0;
        guess_is_lapse = *design == Design::yes_no;
        if constexpr (requires { v.foreign("guess", rate, std::string()); }) {
            for (const char* key : {"guess", "guess_is_lapse"})
                v.foreign(key, rate, "It follows from the design: leave out one of the two.");
        }
    }
};

/// The spec must have exactly one of staircase, quest, quest_plus and constant. `seed`: of the
/// order of constant levels. Throws Error when one of its settings is out of range.
Procedure make_procedure(const ProcedureSpec& spec, uint64_t seed);

/// Problems with the spec go to `diagnostics`.
void check(const ProcedureSpec& spec, Diagnostics& diagnostics);

}  // namespace dihaptic::task
