// Generalisation: how far learning in one direction of reaching carries over to other directions,
// from trials without seen errors (clamps and catch trials) in conditions that were not trained.
#pragma once

#include <string>
#include <vector>

#include "base/table.h"

namespace dihaptic::analysis {

struct Generalisation {
    std::string round;
    std::string condition;
    double angle = 0;         ///< angle from the nearest trained direction [deg]
    double compensation = 0;  ///< mean over these trials, less the baseline's mean [deg]
    double share = 0;  ///< compensation over that in trained directions; NaN if none was probed
    int trials = 0;
};

/// Results by round, then angle; empty if no untrained condition was probed. `trials`: trials.csv;
/// `list`: trial-list.csv, which has the reaches' directions.
std::vector<Generalisation> find_generalisation(const CsvFile& trials, const CsvFile& list);

}  // namespace dihaptic::analysis
