// Draws the page of a report and its figures, using the Python package.
#pragma once

#include <string>

#include "analysis/report/report.h"

namespace dihaptic::app {

/// Where Python's own messages go: directly to the terminal or, for a window without a terminal,
/// into the Error.
enum class PythonSays { on_terminal, in_error };

/// Draws the page of the result, report.html, and its figures next to it. `command`: the command
/// line, shown on the page. Waits until Python has finished. Throws Error when the page could not
/// be drawn.
void draw_page(const analysis::ReportResult& result, const std::string& command, PythonSays says);

}  // namespace dihaptic::app
