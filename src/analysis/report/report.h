// The command `dihaptic report`: makes the tables of a session, or of a folder of sessions. The
// Python package draws a page of them (report_json.h).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/table.h"
#include "recording/session.h"

namespace dihaptic::analysis {

/// Sessions of one experiment whose hands were moved by people of one kind: they may be counted
/// together.
struct ReportSample {
    std::string title;  ///< of the experiment
    recording::MovedBy moved_by;
    std::string not_measured;  ///< perturbations whose learning has no measure; empty: none
    std::string contact;       ///< of a single session: how well the contact solver converged
    Table perturbations;
    std::string note;  ///< of a single session: what was written into note.txt by hand
    std::vector<std::string> folders;  ///< of the sessions
};

struct ReportResult {
    std::vector<std::string> paths;   ///< folders of sessions, or folders that contain them
    std::string out;                  ///< folder for the page of several paths
    std::vector<std::string> tables;  ///< tables written; for a folder, those over people
    int sessions = 0;
    std::vector<std::string> left_out;  ///< sessions left out, each with the reason
    std::vector<Problem> changed;       ///< changes in sessions since they ended
    std::vector<Problem> unwritten;     ///< sessions in whose folders no table could be written
    std::vector<std::string> log;       ///< faults of a session's raw.log, in sentences
    std::vector<ReportSample> samples;

    /// The file of the page that Python draws.
    std::string page() const;
    /// Adds the result of another path, for one page of both.
    void add(const ReportResult& other);
};

/// Whether a study counts a session that ended early, by its folder and its place in the study.
using CountsInStudy = std::function<bool(const std::string&, const recording::InStudy&)>;

/// For one session, writes adaptation.csv, fits.csv, adaptation-blocks.csv, generalisation.csv and
/// thresholds.csv into its folder, as far as there is something to write; reads its raw.log to the
/// end, and reports its faults. For a folder with sessions in it, at any depth, writes these tables
/// of each session that is not left out, and population-people.csv, population-adaptation.csv,
/// population-lifts.csv, population-thresholds.csv and population-measures.csv into the folder.
/// Throws Error when there is no session. `counts`: of sessions in a folder that ended early, those
/// that are counted all the same; empty: none.
ReportResult write_tables(const std::string& path, const std::function<void(double)>& progress,
                          const CountsInStudy& counts = {});

}  // namespace dihaptic::analysis
