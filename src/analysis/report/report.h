// Implements the command `dihaptic report`, which makes the tables of a session or of a folder of
// sessions. The Python package turns them into a page (report_json.h).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/table.h"
#include "recording/session.h"

namespace dihaptic::analysis {

/// Sessions of one experiment in which the hands were moved by people of one kind, so that the
/// sessions may be pooled.
struct ReportSample {
    std::string title;  ///< title of the experiment
    recording::MovedBy moved_by;
    std::string not_measured;  ///< perturbations for which learning has no measure, if any
    std::string contact;       ///< for a single session: how well the contact solver converged
    Table perturbations;
    std::string note;  ///< for a single session: note.txt, and the notes made while it ran
    std::vector<std::string> folders;  ///< folders of the sessions
};

struct ReportResult {
    std::vector<std::string> paths;   ///< folders that are sessions or contain sessions
    std::string out;                  ///< folder for the page, if there are several paths
    std::vector<std::string> tables;  ///< files of the tables written; for a folder of sessions,
                                      ///< only the tables over people
    int sessions = 0;
    std::vector<std::string> left_out;  ///< sessions that were left out, each with the reason
    std::vector<Problem> changed;       ///< changes made to sessions after they ended
    std::vector<Problem> unwritten;     ///< sessions whose tables could not be written
    std::vector<std::string> log;       ///< faults in the raw.log of a session, as sentences
    std::vector<ReportSample> samples;

    /// Path of the page that the Python package will write.
    std::string page() const;
    /// Adds the result for another path, so that one page covers both paths.
    void add(const ReportResult& other);
};

/// Returns whether the study counts a session that ended early, given the session's folder and its
/// place in the study.
using CountsInStudy = std::function<bool(const std::string&, const recording::InStudy&)>;

/// For one session, writes adaptation.csv, fits.csv, adaptation-blocks.csv, generalisation.csv and
/// thresholds.csv into the session's folder (only those with contents), reads its raw.log to the
/// end, and reports the faults found there. For a folder that contains sessions, at any depth,
/// writes these tables for each session that is not left out, and writes population-people.csv,
/// population-adaptation.csv, population-lifts.csv, population-thresholds.csv and
/// population-measures.csv into the folder. Throws Error when there is no session. `counts`: for
/// the sessions in a folder that ended early, returns whether a session is counted all the same; if
/// empty, none of them is counted.
ReportResult write_tables(const std::string& path, const std::function<void(double)>& progress,
                          const CountsInStudy& counts = {});

}  // namespace dihaptic::analysis
