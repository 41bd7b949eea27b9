// Makes signals that would kill or suspend the program end a session properly instead: a killed or
// suspended program would leave its devices with the last commanded force.
//
// Signals that report an error in the program itself, such as SIGSEGV, are not handled, because an
// orderly end is not possible after such an error.
#pragma once

#include <csignal>

#include <array>
#include <atomic>

namespace dihaptic::app {

/// From this call on, a signal that would end the program from outside (Ctrl-C, Ctrl-\, a closed
/// terminal, a logout, a timer, a system limit) only sets `stop`, and writes its number as a byte
/// to the file `wake`, if one is given. A hangup signal that is already ignored stays ignored, as
/// required by nohup, and a signal that already has a handler keeps it. `stop` and `wake` must live
/// as long as the program.
void stop_on_signals(std::atomic<bool>& stop, int wake = -1);

/// While an object of this class exists, signals that would suspend the program, above all Ctrl-Z,
/// end it properly too.
class NoSuspension {
  public:
    NoSuspension();
    ~NoSuspension();
    NoSuspension(const NoSuspension&) = delete;
    NoSuspension& operator=(const NoSuspension&) = delete;

  private:
    std::array<struct sigaction, 3> before_;  // previous action of each signal
};

}  // namespace dihaptic::app
