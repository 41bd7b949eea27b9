// The part of a session's page on the measures that its task lists (task/plan/measures.h): a chart
// of each over the trials, by condition, and of its means over a factor; and how often and why each
// is missing.
#pragma once

#include <span>
#include <string>

#include "analysis/report/page.h"
#include "analysis/report/session_data.h"

namespace dihaptic::analysis {

/// Columns of the trials with the task's measures.
std::vector<Table::Column> measured_columns(const SessionData& session);
/// Adds nothing for a task without measures.
void add_measures(Page& page, const SessionData& session);
/// Adds the means of each measure over a factor, if the experiment of these sessions has one.
void add_measures_of_people(Page& page, std::span<const SessionData* const> sessions,
                            const std::string& origin);

}  // namespace dihaptic::analysis
