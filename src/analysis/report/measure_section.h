// The part of a session's page on the measures that its task lists (task/measures.h): a chart of
// each over the trials, by condition, and how often each is missing, and why.
#pragma once

#include "analysis/report/page.h"
#include "analysis/report/session_data.h"

namespace dihaptic::analysis {

/// Adds nothing for a task without measures.
void add_measures(Page& page, const SessionData& session);

}  // namespace dihaptic::analysis
