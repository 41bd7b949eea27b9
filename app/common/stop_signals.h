// Signals that ask the program to end, or to wait, end a session in order instead: a program that
// is gone, or suspended, leaves its devices with their last force.
//
// Those that tell of an error of its own, SIGSEGV and the like, are none of them: after one nothing
// can be ended in order.
#pragma once

#include <csignal>

#include <array>
#include <atomic>

namespace dihaptic::app {

/// From now on whatever would end the program from outside (Ctrl-C, Ctrl-\, a closed terminal, a
/// log-out, a timer, a limit of the system's) only sets `stop`, and writes the signal's number as a
/// byte to the file `wake`, if there is one. A hangup that is ignored already stays so, as nohup
/// wants. `stop` and `wake` must live as long as the program.
void stop_on_signals(std::atomic<bool>& stop, int wake = -1);

/// As long as it is there, what would suspend the program, Ctrl-Z above all, is such a signal too.
class NoSuspension {
  public:
    NoSuspension();
    ~NoSuspension();
    NoSuspension(const NoSuspension&) = delete;
    NoSuspension& operator=(const NoSuspension&) = delete;

  private:
    std::array<struct sigaction, 3> before_;  // what was done at each
};

}  // namespace dihaptic::app
