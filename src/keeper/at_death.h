// What a program does with its last breath: force off on all kept devices, and a word of it.
#pragma once

namespace dihaptic::keeper {

/// From now on a signal that means an error of the program (SIGSEGV, SIGBUS, SIGFPE, SIGILL,
/// SIGSYS, SIGTRAP, and SIGABRT, by which std::terminate ends it) takes force away first, says so
/// on standard error, and then ends the program as it would have. In any thread.
void take_force_away_at_death();

}  // namespace dihaptic::keeper
