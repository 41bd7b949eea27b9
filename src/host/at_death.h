// Switches the force of all kept devices off when the program crashes, and reports this.
#pragma once

namespace dihaptic::host {

/// Installs handlers for signals caused by errors of the program (SIGSEGV, SIGBUS, SIGFPE,
/// SIGILL, SIGSYS, SIGTRAP, and SIGABRT, from std::terminate), in any thread: force is
/// taken away first, a message goes to standard error, and the program ends as usual.
void take_force_away_at_death();

}  // namespace dihaptic::host
