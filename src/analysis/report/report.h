// dihaptic report: what a session, or a folder of them, showed, as a page and as tables.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace dihaptic::analysis {

struct ReportResult {
    std::string page;                 ///< report.html
    std::vector<std::string> tables;  ///< beside it
    int sessions = 0;
    std::vector<std::string> left_out;  ///< sessions, each with why
    std::vector<std::string> log;       ///< what is wrong with a session's raw.log, in sentences
};

/// Of one session: report.html in its folder, with adaptation.csv and fits.csv where it has
/// reaches. Of a folder with sessions in it, at any depth: report.html there, with
/// population-people.csv, population-adaptation.csv, population-thresholds.csv and
/// population-lifts.csv. `command`: how the report was asked for, which it tells. Throws Error when
/// there is no session.
ReportResult write_report(const std::string& path, const std::string& command,
                          const std::function<void(double)>& progress);

}  // namespace dihaptic::analysis
