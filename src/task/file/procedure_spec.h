// Procedures (procedures/) as described in an experiment file. In each trial, a procedure uses the
// answers so far to choose the share of a perturbation, from 0 to 1, or a named number for use in
// formulas.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "task/file/ref.h"
#include "task/procedures/procedure.h"

namespace dihaptic::task {

/// Largest absolute level; a larger value, in any unit, is assumed to be a typing error.
constexpr double kFurthestLevel = 1e6;

struct StaircaseSpec {
    int down_after = 1;
    double start = 1;
    std::vector<double> steps_up;
    double down_over_up = 1;
    std::optional<double> lowest;
    std::optional<double> highest;
    /// Number of reversals after which the staircase ends; if 0, it ends after `trials`.
    int reversals = 0;
    int skipped_reversals = 0;

    template <class Visitor>
    void visit(Visitor& v) {
        v("down_after", down_after,
          Field::number().within(1, 10).says(
              "Number of consecutive 'yes' answers that lower the level."));
        v("start", start,
          Field::number()
              .within(-kFurthestLevel, kFurthestLevel)
              .required()
              .says("Level of the first trial."));
        v("steps_up", steps_up,
          Field::number()
              .within(1e-6, kFurthestLevel)
              .required()
              .says("Steps up, each used until the next reversal; the last one remains in use."));
        v("down_over_up", down_over_up,
          Field::number().within(0.01, 100).says("Ratio of the step down to the step up."));
        v("lowest", lowest,
          Field::number()
              .within(-kFurthestLevel, kFurthestLevel)
              .says("Lowest level; the lowest share if omitted."));
        v("highest", highest,
          Field::number()
              .within(-kFurthestLevel, kFurthestLevel)
              .says("Highest level; the highest share if omitted."));
        v("reversals", reversals,
          Field::number().within(0, 1000).says("Number of reversals after which the staircase "
                                               "ends; 0: it ends after the procedure's trials."));
        v("skipped_reversals", skipped_reversals,
          Field::number().within(0, 1000).says(
              "Number of initial reversals that are ignored in the threshold."));
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
              .says("Standard deviation of the threshold's prior distribution."));
        v("target", target,
          Field::number().within(0, 1).says("Probability of 'yes' at the threshold."));
        v("slope", slope,
          Field::number().within(1e-3, 1000).says("Slope of the Weibull function."));
        v("blind", blind,
          Field::number().within(0, 1).says("Share of trials that are answered blindly."));
        v("grain", grain, Field::number().within(1e-6, 10).says("Step of the grid of levels."));
        v("cells", cells, Field::number().within(2, 10000).says("Number of levels in the grid."));
        v("lowest", lowest,
          Field::number().within(-kFurthestLevel, kFurthestLevel).says("Lowest level."));
        v("highest", highest,
          Field::number().within(-kFurthestLevel, kFurthestLevel).says("Highest level."));
    }
};

/// Equally spaced values, including both ends.
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
        v("levels", levels, Field::number().required().says("Levels that may be presented."));
        v("thresholds", thresholds,
          Field::number().required().says("Grid of possible thresholds."));
        v("shapes", shapes,
          Field::number().required().says("Grid of possible slopes of the function."));
        v("lapses", lapses, says("Grid of possible lapse rates; only 0.02 if omitted."));
    }
};

/// Levels that do not depend on the answers: each level occurs once in every round, in random
/// order.
struct ConstantSpec {
    std::vector<double> levels;

    template <class Visitor>
    void visit(Visitor& v) {
        v("levels", levels,
          Field::number()
              .within(-kFurthestLevel, kFurthestLevel)
              .required()
              .says("Levels, each of which is presented equally often."));
    }
};

/// Kind of question, which determines the guess rate. yes_no: a question about presence or
/// direction, for which the guess rate equals the lapse rate. 2afc: a choice between two intervals.
enum class Design { yes_no, two_alternatives };
constexpr auto enum_names(Design) {
    return std::array{"yes_no", "2afc"};
}

struct PerturbationSpec;

struct ProcedureSpec {
    std::string name;
    /// Perturbations whose share is the level, unless `level` is given.
    Refs<PerturbationSpec> perturb;
    std::string level;  ///< name of the number chosen, which gives the unit of levels; if empty, a
                        ///< share is chosen
    std::optional<double> standard;  ///< value of the number wherever no procedure chooses it
    bool logarithmic = false;        ///< whether the share or the number is 10^level
    std::string yes;                 ///< outcome whose probability increases with the level
    std::string no;
    int trials = 40;  ///< maximum number of trials
    std::optional<model::Sigmoid> sigmoid;
    std::optional<Design> design;
    double guess = 0.5;  ///< probability of "yes" far below the threshold
    /// Whether the guess rate equals the lapse rate; this replaces `guess`.
    bool guess_is_lapse = false;
    std::optional<StaircaseSpec> staircase;
    std::optional<QuestSpec> quest;
    std::optional<QuestPlusSpec> quest_plus;
    std::optional<ConstantSpec> constant;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the procedure."));
        v("perturb", perturb,
          says("Perturbation whose share is the level; or give 'level' instead."));
        v("level", level,
          says("Name, with unit, of the number that the procedure chooses for use in formulas."));
        v("standard", standard,
          Field::number()
              .within(-kFurthestLevel, kFurthestLevel)
              .says("Value of the number in the other interval of a two-interval trial."));
        v("logarithmic", logarithmic,
          says("Whether the level is log10 of the share or the number."));
        v("yes", yes, says("Outcome whose probability grows with the level."));
        v("no", no, says("The other outcome."));
        v("trials", trials, Field::number().within(1, 1000).says("Largest number of trials."));
        v("sigmoid", sigmoid,
          says("Psychometric function of the fit; if omitted, normal, or for 'quest' the function "
               "that it assumes: weibull_log10 with its slope."));
        v("design", design, says("Kind of question in a trial, which determines 'guess'."));
        visit_guess(v);
        v("staircase", staircase, says("A staircase chooses the level."));
        v("quest", quest, says("QUEST chooses the level."));
        v("quest_plus", quest_plus, says("QUEST+ chooses the level."));
        v("constant", constant, says("Constant stimuli: each level is presented equally often."));
    }

    /// Limits on the levels that the procedure may propose; infinite if no limits are given.
    double most() const;
    double least() const;
    /// Converts the level `at` to the share, or to the number in the unit of its name.
    double share(double at) const;
    /// Psychometric function that is fitted to the answers.
    model::Sigmoid fitted() const {
        return sigmoid.value_or(quest ? model::Sigmoid::weibull_log10 : model::Sigmoid::normal);
    }
    /// Shape of the fitted function if the procedure assumes the shape rather than fitting it to
    /// the answers; otherwise unset.
    std::optional<double> known_shape() const {
        if (quest && fitted() == model::Sigmoid::weibull_log10) return quest->slope;
        return std::nullopt;
    }
    /// Key of the procedure in the file.
    const char* kind() const;

  private:
    template <class Visitor>
    void visit_guess(Visitor& v) {
        const Field rate = Field::number().within(0, 1);
        if (!design) {
            v("guess", guess, rate.says("Probability of 'yes' far below the threshold."));
            v("guess_is_lapse", guess_is_lapse,
              says("Whether the guess rate equals the lapse rate."));
            return;
        }
        guess = *design == Design::two_alternatives ? 0.5 : 0;
        guess_is_lapse = *design == Design::yes_no;
        if constexpr (requires { v.foreign("guess", rate, std::string()); }) {
            for (const char* key : {"guess", "guess_is_lapse"})
                v.foreign(key, rate, "The design determines it: leave out one of the two.");
        }
    }
};

/// Makes the procedure. The spec must have exactly one of staircase, quest, quest_plus and
/// constant. `seed` determines the order of constant levels. Throws Error if a setting is out of
/// range.
Procedure make_procedure(const ProcedureSpec& spec, uint64_t seed);

/// Checks the spec. Problems are added to `diagnostics`.
void check(const ProcedureSpec& spec, Diagnostics& diagnostics);

}  // namespace dihaptic::task
