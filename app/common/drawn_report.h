// Draws the page of a report and its figures, using the Python package.
#pragma once

#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "base/child.h"
#include "base/descriptor.h"

namespace dihaptic::app {

/// Where Python's own messages go: directly to the terminal or, for a window without a terminal,
/// into the Error.
enum class PythonSays { on_terminal, in_error };

/// Python takes about a second to load what it draws with. It is therefore started before the
/// tables are made, and ends with this object if draw() is never called.
class PageDrawer {
  public:
    /// Starts Python. `folders`: those that the page is about.
    PageDrawer(const std::vector<std::string>& folders, PythonSays says);

    /// Draws the page of the result, report.html, and its figures next to it. `command`: the
    /// command line, shown on the page. Waits until Python has finished. Throws Error when the page
    /// could not be drawn. Must be called at most once.
    void draw(const analysis::ReportResult& result, const std::string& command);

  private:
    std::string package_;  // folder of the Python package; empty if there is none
    PythonSays says_;
    Descriptor description_;  // what is sent here is Python's standard input
    Descriptor said_;         // Python's messages, for PythonSays::in_error
    int failed_ = 0;          // error number of the start
    Child python_;
};

}  // namespace dihaptic::app
