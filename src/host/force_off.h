// Switches the force of all kept devices off when this program is about to die.
#pragma once

#include <array>
#include <csignal>

#include "host/shared_page.h"

namespace dihaptic::host {

/// Signals by which a process dies from its own error.
inline constexpr std::array kErrors{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGTRAP, SIGABRT};

/// Longest wait of a dying program for the report that force is off.
constexpr Time kLastWait = std::chrono::milliseconds(2);

/// Tells every device host of this program to switch the force off, and waits for at most kLastWait
/// until they confirm this. Returns false if one has not, in which case only its devices' own
/// guards are left. Returns true if there is no device host. Async-signal-safe, from any thread.
bool force_off_now() noexcept;

/// Whether a device host notified by end_force() at `since` (of monotonic()) reports that force is
/// off; waits at most until kLastWait after `since`. Async-signal-safe.
bool await_off(const SharedPage& page, int64_t since) noexcept;

/// Adds a device host's page to the list for force_off_now(), and removes it again; it is listed
/// while devices are active.
void watch_over(SharedPage* page) noexcept;
void forget(SharedPage* page) noexcept;

}  // namespace dihaptic::host
