// What a session's end looks like on the screen.
#pragma once

#include "analysis/session_report.h"
#include "experiment/session_run.h"

namespace dihaptic::cli {

/// The table of phases, limits that were met, timing, and the folder.
void print_summary(const analysis::SessionFigures& figures, const experiment::Plan& plan,
                   const experiment::RunResult& result);
/// What a recorded movement had wrong with it.
void print_movement(const experiment::MovementReport& report, size_t most_lines);

/// Runs a plan and tells of it.
void run_plan(const experiment::Plan& plan, experiment::RunOptions run);

/// Finishes the session's files, with progress.
analysis::SessionFigures finish(const experiment::RunResult& result);

}  // namespace dihaptic::cli
