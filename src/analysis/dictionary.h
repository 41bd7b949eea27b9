// Describes the columns of a session's tables.
#pragma once

#include <string>
#include <vector>

#include "base/table.h"
#include "recording/session.h"

namespace dihaptic::analysis {

/// Returns the columns of `file` (trials.csv, lifts.csv or corrections.csv) with these names, each
/// with its unit and description. Known columns are those that every session has and, in
/// trials.csv, the task's own factors, draws, variables, answers and measures. The description of
/// an unknown name, as in tables of later versions, is empty.
std::vector<Table::Column> described_columns(const recording::SessionFolder& session,
                                             const std::string& file,
                                             const std::vector<std::string>& names);

}  // namespace dihaptic::analysis
