// Switches off the force of all devices that this program holds when the program crashes, and
// reports the crash.
#pragma once

namespace dihaptic::host {

/// Installs handlers for signals that are caused by program errors (SIGSEGV, SIGBUS, SIGFPE,
/// SIGILL, SIGSYS, SIGTRAP, and SIGABRT, which std::terminate raises) in any thread. A handler
/// first switches force off, then writes a message to standard error, and then lets the program end
/// as usual.
void take_force_away_at_death();

}  // namespace dihaptic::host
