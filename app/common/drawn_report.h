// Draws the page of a report with its figures, by the Python package.
#pragma once

#include <string>

#include "analysis/report/report.h"

namespace dihaptic::app {

/// The folder in which Python finds the package dihaptic, here or installed; "" if there is none.
std::string python_folder();

/// Where what Python says of itself goes: to the terminal as it is said, or into the Error, for a
/// window that has no terminal.
enum class PythonSays { on_terminal, in_error };

/// Draws the result's page, report.html, and its figures beside it. `command`: the command line,
/// shown on the page. Waits until Python is done. Throws Error when there is no page.
void draw_page(const analysis::ReportResult& result, const std::string& command, PythonSays says);

}  // namespace dihaptic::app
