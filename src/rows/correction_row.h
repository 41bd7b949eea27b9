// A row of corrections.csv. analysis/corrections.h describes how corrections are found.
#pragma once

#include <string>

#include "base/unmeasured.h"
#include "rows/row_file.h"

namespace dihaptic::rows {

/// The correction found in the trials of a condition, in SI units; NaN if it was not found.
struct CorrectionRow {
    std::string round, condition, perturbation;
    int trials = 0, matched = 0, left_out = 0;
    double compared = kUnmeasured;
    double latency = kUnmeasured;
    double acceleration = kUnmeasured;
    double velocity = kUnmeasured, at = kUnmeasured, error = kUnmeasured;
    std::string why;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("round", f.round, "", "name");
        v("condition", f.condition, "", "name");
        v("perturbation", f.perturbation, "", "name, or names joined by ' + '; empty: none");
        v("trials", f.trials, "1", "trials in which something happened");
        v("matched", f.matched, "1", "matched trials, in which nothing happened");
        v("left_out", f.left_out, "1",
          "trials of both kinds that ended before the end of the comparison");
        v("compared", f.compared, "s",
          "time for which the means are compared; nine tenths of the trials of each kind last as "
          "long");
        v("latency", f.latency, "s",
          "time from the state's beginning to the correction's, where the line through 25 % and 75 "
          "% of the acceleration's peak reaches zero (Oostwoud Wijdenes, Brenner and Smeets "
          "2014)");
        v("acceleration", f.acceleration, "m/s2",
          "peak acceleration of the correction along the axis, from the difference of the means");
        v("velocity", f.velocity, "m/s",
          "peak of the difference of the mean velocities along the axis, in its first excursion");
        v("velocity_at", f.at, "s", "time of this peak");
        v("velocity_error", f.error, "m/s", "standard error of this difference");
        v("not_measured", f.why, "", "reason why there is no latency");
    }
};

}  // namespace dihaptic::rows
