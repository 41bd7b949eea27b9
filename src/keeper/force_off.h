// Takes the force of all kept devices away when this program is about to die.
#pragma once

#include "keeper/shared_page.h"

namespace dihaptic::keeper {

/// How long a dying program waits to hear that force is off.
constexpr Time kLastWait = std::chrono::milliseconds(2);

/// Tells every keeper of this program to take force away, and waits until they say that they have,
/// for kLastWait at most. False when one has not said so: then its devices' own guards are what is
/// left. True when there is none. Async-signal-safe, from any thread.
bool force_off_now() noexcept;

/// From when devices are active until they are not.
void watch_over(SharedPage* page) noexcept;
void forget(SharedPage* page) noexcept;

}  // namespace dihaptic::keeper
