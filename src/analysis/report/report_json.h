// Passes on to the Python package, which draws the page of a report, whatever the tables next to
// the page do not contain.
#pragma once

#include <string>

#include "analysis/report/report.h"

namespace dihaptic::analysis {

/// Returns the report as JSON text. `command`: the command line that is shown on the page.
std::string report_json(const ReportResult& result, const std::string& command);

}  // namespace dihaptic::analysis
