// Reads keys from the terminal while a session runs on the real clock: Escape asks the session to
// stop, like Ctrl-C. Until the object is destroyed, keys are read as they are pressed, without
// echo.
#pragma once

#include <termios.h>

#include <atomic>
#include <thread>

#include "base/ring.h"

namespace dihaptic::cli {

class EscapeKey {
  public:
    /// Sets `pressed` when Escape is pressed, and adds any other key to `keys`. Does nothing when
    /// standard input is not a terminal, or when another program is in the foreground of the
    /// terminal.
    EscapeKey(std::atomic<bool>& pressed, ValueRing<char>& keys);
    ~EscapeKey();
    EscapeKey(const EscapeKey&) = delete;
    EscapeKey& operator=(const EscapeKey&) = delete;

    /// Whether keys are being read.
    bool listens() const { return listens_; }
    /// Restores the terminal, for a program that must exit at once. May be called from any thread.
    void restore() noexcept;

  private:
    void listen(std::atomic<bool>& pressed, ValueRing<char>& keys);

    bool listens_ = false;
    termios before_{};
    std::atomic<bool> done_{false};
    std::thread thread_;
};

}  // namespace dihaptic::cli
