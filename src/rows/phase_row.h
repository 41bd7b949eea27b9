// A row of phases.csv.
#pragma once

#include <string>

#include "rows/row_file.h"

namespace dihaptic::rows {

/// The figures of one phase, in SI units.
struct PhaseRow {
    double start = 0, end = 0;
    int trial = 0;
    std::string name;
    double mean_grip = 0, peak_grip = 0, mean_load = 0, mean_force = 0, peak_force = 0, slip = 0;
    double weight_felt = 0, mean_torque = 0, peak_torque = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("start_time", f.start, "s", "from the session's start");
        v("stop_time", f.end, "s", "from the session's start");
        v("trial", f.trial, "1", "trial number, from 1");
        v("phase", f.name, "", "name of the phase");
        v("mean_grip", f.mean_grip, "N",
          "pinch component of the normal forces, mean over digits; empty with one finger");
        v("peak_grip", f.peak_grip, "N", "largest grip force");
        v("mean_load", f.mean_load, "N",
          "tangential contact forces along gravity, summed over the digits");
        v("mean_force", f.mean_force, "N", "largest of the fingers' mean forces");
        v("peak_force", f.peak_force, "N", "largest force on any finger");
        v("slip", f.slip, "mm",
          "largest slip of a finger on the object; empty unless all held it throughout");
        v("weight_felt", f.weight_felt, "1",
          "ratio of vertical handle forces to the object's weight in the trial; empty unless it is "
          "carried");
        v("mean_torque", f.mean_torque, "N*m",
          "mean over time of the largest torque on any handle; empty without orientation");
        v("peak_torque", f.peak_torque, "N*m", "largest torque on any handle");
    }
};

using PhaseFile = RowFile<PhaseRow>;

}  // namespace dihaptic::rows
