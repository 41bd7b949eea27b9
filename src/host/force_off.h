// Switches off the force of all devices that this program holds when it is about to die.
#pragma once

#include <array>
#include <csignal>

#include "host/shared_page.h"

namespace dihaptic::host {

/// Signals by which a process ends because of its own error.
inline constexpr std::array kErrors{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGTRAP, SIGABRT};

/// The longest time that a dying program waits for the report that force is off.
constexpr Time kLastWait = std::chrono::milliseconds(2);

/// Tells every device host of this program to switch force off, and waits for at most kLastWait
/// until all of them have confirmed this. Returns false if one of them has not, in which case only
/// the guards of its devices themselves remain. Returns true if there is no device host.
/// Async-signal-safe; may be called from any thread.
bool force_off_now() noexcept;

/// Whether a device host that end_force() notified at time `since` (on the clock of monotonic())
/// reports that force is off. Waits until kLastWait after `since` at the latest. Async-signal-safe.
bool await_off(const SharedPage& page, int64_t since) noexcept;

/// Adds the page of a device host to the list for force_off_now(), or removes it again. It is in
/// the list while the devices are active.
void watch_over(SharedPage* page) noexcept;
void forget(SharedPage* page) noexcept;

}  // namespace dihaptic::host
