// Takes force away from all kept devices when the program crashes, and says so.
#pragma once

namespace dihaptic::keeper {

/// Installs handlers for the signals that mean an error of the program (SIGSEGV, SIGBUS, SIGFPE,
/// SIGILL, SIGSYS, SIGTRAP, and SIGABRT, by which std::terminate ends it), in any thread: force is
/// taken away first, a message goes to standard error, and the program ends as it would have.
void take_force_away_at_death();

}  // namespace dihaptic::keeper
