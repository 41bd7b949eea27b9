// Runs a session from the terminal and prints its summary.
#pragma once

#include "session/record.h"

namespace dihaptic::cli {

/// Prints the table of trials or phases, the notes, the timing and the session's folder.
void print_summary(const session::Recorded& session, const session::Plan& plan);
/// Prints the faults of a recorded movement.
void print_movement(const session::MovementReport& report, size_t most_lines);

/// Records a session that follows the plan, and prints its summary.
void run_plan(session::Plan plan, session::RunOptions run);

}  // namespace dihaptic::cli
