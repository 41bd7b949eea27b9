// Runs a session from the terminal, and prints its summary.
#pragma once

#include "analysis/session_report.h"
#include "experiment/session_run.h"

namespace dihaptic::cli {

/// Prints the table of trials or phases, limits that were met, timing, and the folder.
void print_summary(const analysis::SessionFigures& figures, const experiment::Plan& plan,
                   const experiment::RunResult& result);
/// Prints what was wrong with a recorded movement.
void print_movement(const experiment::MovementReport& report, size_t most_lines);

/// Runs a plan, finishes its session, and prints the summary.
void run_plan(const experiment::Plan& plan, experiment::RunOptions run);

/// Finishes the session's files, with progress.
analysis::SessionFigures finish(const experiment::RunResult& result);

}  // namespace dihaptic::cli
