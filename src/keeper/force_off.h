// Takes the force of all kept devices away when this program is about to die.
#pragma once

#include <array>
#include <csignal>

#include "keeper/shared_page.h"

namespace dihaptic::keeper {

/// Signals by which a process dies of an error of its own.
inline constexpr std::array kErrors{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGTRAP, SIGABRT};

/// How long a dying program waits to hear that force is off.
constexpr Time kLastWait = std::chrono::milliseconds(2);

/// Tells every keeper of this program to take force away, and waits until they say that they have,
/// for kLastWait at most. False when one has not said so: then its devices' own guards are what is
/// left. True when there is none. Async-signal-safe, from any thread.
bool force_off_now() noexcept;

/// Whether a keeper that was told by end_force() at `since` (of monotonic()) says that force is
/// off; waits for kLastWait at most. Async-signal-safe.
bool await_off(const SharedPage& page, int64_t since) noexcept;

/// From when devices are active until they are not.
void watch_over(SharedPage* page) noexcept;
void forget(SharedPage* page) noexcept;

}  // namespace dihaptic::keeper
