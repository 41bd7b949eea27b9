// Numbers that procedures choose for use in formulas (task/file/procedure_spec.h), and the
// intervals of a trial: in one of the two intervals, drawn for each trial, the number has the level
// that the procedure chose; elsewhere, the number has its standard value.
#pragma once

#include <string>
#include <vector>

#include "task/file/task.h"

namespace dihaptic::task {

/// Name of the draw that determines the interval with the comparison, 1 or 2.
inline constexpr const char* kComparisonInterval = "comparison_interval";
/// Outcomes of a trial that ends with the choice of an interval. They tell whether the chosen
/// interval contained the comparison or the standard.
inline constexpr const char* kComparison = "comparison";
inline constexpr const char* kStandard = "standard";

bool has_intervals(const Task& task);
/// Adds the draw of the comparison interval, and sets the outcomes of procedures that do not name
/// them. Reports inconsistencies.
void complete_intervals(Task& task, Diagnostics& diagnostics);

struct LevelName {
    std::string name;
    double standard;             ///< standard value in the unit of the number's name, like `values`
    std::vector<double> values;  ///< levels for which trials are checked
    Place place;
};
/// Returns the numbers that procedures choose, one entry for each name: several procedures can
/// choose the same number.
std::vector<LevelName> levels_of(const Task& task);

/// Returns the questions asked by states, one entry for each answer name: several states can ask
/// the same question.
std::vector<AskSpec> questions_of(const Task& task);
/// For each state, returns the title and version of its form, or "" if it has no form. Returns an
/// empty list if the task has no forms.
std::vector<std::string> forms_of(const Task& task);

}  // namespace dihaptic::task
