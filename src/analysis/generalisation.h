// How far what was learned in one direction of reaching carries to others: told by trials in which
// no error was seen (clamps and catch trials), in conditions that were not trained.
#pragma once

#include <string>
#include <vector>

#include "base/table.h"

namespace dihaptic::analysis {

struct Generalisation {
    std::string round;
    std::string condition;
    double angle = 0;         ///< from the nearest trained direction [deg]
    double compensation = 0;  ///< mean of its probes, less the baseline's mean [deg]
    double share = 0;         ///< of that in the trained directions; NaN where none was probed
    int trials = 0;
};

/// By round, then angle; none where no untrained condition was probed. `trials`: trials.csv;
/// `list`: trial-list.csv, which has the reaches' directions.
std::vector<Generalisation> find_generalisation(const CsvFile& trials, const CsvFile& list);

}  // namespace dihaptic::analysis
