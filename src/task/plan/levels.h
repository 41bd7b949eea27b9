// Numbers that procedures choose for use in formulas (task/file/procedure_spec.h), and the
// intervals of a trial: in one of the two, drawn for each trial, such a number has the level that
// the procedure chose; elsewhere it has its standard.
#pragma once

#include <string>
#include <vector>

#include "task/file/task.h"

namespace dihaptic::task {

/// The draw of the interval with the comparison, 1 or 2.
inline constexpr const char* kComparisonInterval = "comparison_interval";
/// Outcomes of a trial that ends with the choice of an interval: whether that interval had the
/// comparison or the standard.
inline constexpr const char* kComparison = "comparison";
inline constexpr const char* kStandard = "standard";

bool has_intervals(const Task& task);
/// Adds the draw of the comparison interval, and sets outcomes that procedures leave unnamed.
/// Reports inconsistencies.
void complete_intervals(Task& task, Diagnostics& diagnostics);

struct LevelName {
    std::string name;
    double standard;             ///< in the unit of the number's name, like `values`
    std::vector<double> values;  ///< levels at which trials are checked
    Place place;
};
/// The numbers, one for each name; several procedures can choose the same number.
std::vector<LevelName> levels_of(const Task& task);

/// The questions of states, one for each name of an answer: several states can ask the same
/// question.
std::vector<AskSpec> questions_of(const Task& task);
/// By state: title and version of its form; "" if it has no form. Empty if the task has no forms.
std::vector<std::string> forms_of(const Task& task);

}  // namespace dihaptic::task
