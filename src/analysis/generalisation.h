// Measures generalisation, i.e. how far learning in one direction of reaching carries over to other
// directions. It is measured in trials of untrained conditions in which no error was visible
// (clamps and catch trials).
#pragma once

#include <string>
#include <vector>

#include "rows/trial_row.h"
#include "task/plan/reach_plan.h"

namespace dihaptic::analysis {

struct Generalisation {
    std::string round;
    std::string condition;
    double angle_deg = 0;
    double compensation_deg = 0;
    std::string baseline;
    double share = 0;
    int trials = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("round", f.round, "", "name");
        v("condition", f.condition, "", "name");
        v("angle_deg", f.angle_deg, "deg",
          "angle from the nearest trained direction, positive about the axis of the reach");
        v("compensation_deg", f.compensation_deg, "deg", "mean compensation, minus the baseline's");
        v("baseline", f.baseline, "",
          "trials that gave the baseline: those of the condition before training, those of all "
          "conditions, or none");
        v("share", f.share, "1",
          "compensation as a share of that in trained directions, whatever their conditions' "
          "names; empty if no trained direction was probed");
        v("trials", f.trials, "1", "trials in which no error was seen");
    }
};

/// Returns the results ordered by round, then angle. Empty if no untrained condition was probed.
/// `trials`: contents of trials.csv; `reaches`: one per trial.
std::vector<Generalisation> find_generalisation(const rows::TrialFile& trials,
                                                const std::vector<task::ReachPlan>& reaches);

}  // namespace dihaptic::analysis
