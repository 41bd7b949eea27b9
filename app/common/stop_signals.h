// Makes signals that ask the program to end or to wait end a session properly instead: a killed or
// suspended program leaves its devices with their last force.
//
// Signals of an error in the program itself, such as SIGSEGV, are not handled, because no orderly
// end is possible after one.
#pragma once

#include <csignal>

#include <array>
#include <atomic>

namespace dihaptic::app {

/// From now on a signal that would end the program from outside (Ctrl-C, Ctrl-\, a closed terminal,
/// a log-out, a timer, a limit of the system) only sets `stop`, and writes its number as a byte to
/// the file `wake`, if there is one. A hangup that is already ignored stays ignored, as required by
/// nohup, and a signal that already has a handler keeps it. `stop` and `wake` must live as long as
/// the program.
void stop_on_signals(std::atomic<bool>& stop, int wake = -1);

/// While this exists, signals that would suspend the program, above all Ctrl-Z, end it properly
/// too.
class NoSuspension {
  public:
    NoSuspension();
    ~NoSuspension();
    NoSuspension(const NoSuspension&) = delete;
    NoSuspension& operator=(const NoSuspension&) = delete;

  private:
    std::array<struct sigaction, 3> before_;  // previous action of each
};

}  // namespace dihaptic::app
