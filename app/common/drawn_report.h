// Draws the page of a report with its figures, using the Python package.
#pragma once

#include <string>

#include "analysis/report/report.h"

namespace dihaptic::app {

/// Where Python's own messages go: to the terminal at once, or into the Error, for a window without
/// a terminal.
enum class PythonSays { on_terminal, in_error };

/// Draws the result's page, report.html, and its figures next to it. `command`: the command line,
/// shown on the page. Waits until Python is done. Throws Error when there is no page.
void draw_page(const analysis::ReportResult& result, const std::string& command, PythonSays says);

}  // namespace dihaptic::app
