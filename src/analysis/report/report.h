// The command `dihaptic report`: shows the results of a session, or of a folder of sessions, as a
// page and as tables.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic::analysis {

struct ReportResult {
    std::string page;                 ///< report.html
    std::vector<std::string> tables;  ///< tables written beside the page
    int sessions = 0;
    std::vector<std::string> left_out;  ///< sessions left out, each with the reason
    std::vector<Problem> changed;       ///< changes in sessions since they ended
    std::vector<std::string> log;       ///< faults of a session's raw.log, in sentences
};

/// For one session, writes report.html in its folder, with adaptation.csv and fits.csv if it has
/// reaches. For a folder with sessions in it, at any depth, writes report.html there, with
/// population-people.csv, population-adaptation.csv, population-thresholds.csv,
/// population-lifts.csv and population-measures.csv. `command`: the command line, shown in the
/// report. Throws Error when there is no session.
ReportResult write_report(const std::string& path, const std::string& command,
                          const std::function<void(double)>& progress);

}  // namespace dihaptic::analysis
