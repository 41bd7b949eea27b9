// Numbers that procedures choose (task/file/procedure_spec.h), which formulas name, and the
// intervals of a trial: in one of the two, drawn for each trial, such a number has the level that
// the procedure chose, and everywhere else its standard.
#pragma once

#include <string>
#include <vector>

#include "task/file/task.h"

namespace dihaptic::task {

/// The draw of the interval that has the comparison, 1 or 2.
inline constexpr const char* kComparisonInterval = "comparison_interval";
/// Outcomes of a trial that ends by an answer that chooses an interval: which it had.
inline constexpr const char* kComparison = "comparison";
inline constexpr const char* kStandard = "standard";

bool has_intervals(const Task& task);
/// Adds what follows from intervals: the draw of the comparison's, and outcomes that procedures do
/// not name. Reports what does not fit together.
void complete_intervals(Task& task, Diagnostics& diagnostics);

struct LevelName {
    std::string name;
    double standard;             ///< in the unit of its name, as all that follows
    std::vector<double> values;  ///< at which it is looked whether trials are possible
    Place place;
};
/// One for each name; several procedures may choose the same number.
std::vector<LevelName> levels_of(const Task& task);

/// The questions of states, one for each name of an answer: several states may ask for the same.
std::vector<AskSpec> questions_of(const Task& task);

}  // namespace dihaptic::task
