// Adaptive procedures (procedures/) as an experiment file describes them: the share of a
// perturbation in each trial, from 0 to 1, follows from the answers so far.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "task/procedures/procedure.h"

namespace dihaptic::task {

/// Shares lie in 0 to 1 and their logarithms within a few units: a level beyond this is a slip.
constexpr double kFurthestLevel = 100;

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
        v("down_after", down_after, Field::number().within(1, 10));
        v("start", start, Field::number().within(-kFurthestLevel, kFurthestLevel).required());
        v("steps_up", steps_up, Field::number().within(1e-6, kFurthestLevel).required());
        v("down_over_up", down_over_up, Field::number().within(0.01, 100));
        v("lowest", lowest, Field::number().within(-kFurthestLevel, kFurthestLevel));
        v("highest", highest, Field::number().within(-kFurthestLevel, kFurthestLevel));
        v("reversals", reversals, Field::number().within(0, 1000));
        v("skipped_reversals", skipped_reversals, Field::number().within(0, 1000));
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

    template <class Visitor>
    void visit(Visitor& v) {
        v("prior_mean", prior_mean,
          Field::number().within(-kFurthestLevel, kFurthestLevel).required());
        v("prior_sd", prior_sd, Field::number().within(1e-6, kFurthestLevel).required());
        v("target", target, Field::number().within(0, 1));
        v("slope", slope, Field::number().within(1e-3, 1000));
        v("blind", blind, Field::number().within(0, 1));
        v("grain", grain, Field::number().within(1e-6, 10));
        v("cells", cells, Field::number().within(2, 10000));
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
        v("from", from, Field::number().within(-1e4, 1e4).required());
        v("to", to, Field::number().within(-1e4, 1e4).required());
        v("count", count, Field::number().within(1, 1000).required());
    }
};

struct QuestPlusSpec {
    GridSpec levels;
    GridSpec thresholds;
    GridSpec shapes;
    GridSpec lapses{0.02, 0.02, 1};

    template <class Visitor>
    void visit(Visitor& v) {
        v("levels", levels, Field::number().required());
        v("thresholds", thresholds, Field::number().required());
        v("shapes", shapes, Field::number().required());
        v("lapses", lapses);
    }
};

struct ProcedureSpec {
    std::string name;
    std::string perturb;       ///< perturbation whose share is the level
    bool logarithmic = false;  ///< the share is 10^level
    std::string yes;           ///< the outcome that grows likelier with the level
    std::string no;
    int trials = 40;  ///< largest number
    model::Sigmoid sigmoid = model::Sigmoid::normal;
    double guess = 0.5;           ///< probability of "yes" far below the threshold
    bool guess_is_lapse = false;  ///< the guess rate is the lapse rate, instead
    std::optional<StaircaseSpec> staircase;
    std::optional<QuestSpec> quest;
    std::optional<QuestPlusSpec> quest_plus;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required());
        v("perturb", perturb, Field::text().required());
        v("logarithmic", logarithmic);
        v("yes", yes, Field::text().required());
        v("no", no, Field::text().required());
        v("trials", trials, Field::number().within(1, 1000));
        v("sigmoid", sigmoid);
        v("guess", guess, Field::number().within(0, 1));
        v("guess_is_lapse", guess_is_lapse);
        v("staircase", staircase);
        v("quest", quest);
        v("quest_plus", quest_plus);
        if constexpr (requires { v.place(); }) place = v.place();
    }

    /// Range of the levels, as of the shares: 0 to 1, or the logarithms of that.
    double most() const { return logarithmic ? 0 : 1; }
    double least() const { return logarithmic ? -std::numeric_limits<double>::infinity() : 0; }
    double share(double level) const { return logarithmic ? std::pow(10, level) : level; }
    /// The procedure's key in the file.
    const char* kind() const { return staircase ? "staircase" : quest ? "quest" : "quest_plus"; }
};

/// The spec must have exactly one of staircase, quest and quest_plus. Throws Error when one of its
/// settings is out of range.
Procedure make_procedure(const ProcedureSpec& spec);

/// Problems with the spec go to `diagnostics`.
void check(const ProcedureSpec& spec, Diagnostics& diagnostics);

}  // namespace dihaptic::task
