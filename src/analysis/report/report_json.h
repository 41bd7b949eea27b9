// Tells the Python package, which draws the page of a report, what the tables next to it do not
// contain.
#pragma once

#include <string>

#include "analysis/report/report.h"

namespace dihaptic::analysis {

/// JSON text. `command`: the command line, shown on the page.
std::string report_json(const ReportResult& result, const std::string& command);

}  // namespace dihaptic::analysis
