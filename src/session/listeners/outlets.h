// Sends the event codes, handle positions and forces of a running session to a lab's other
// recording systems, and receives triggers from them.
#pragma once

#include "session/listeners/listener.h"

namespace dihaptic::session {

/// Returns null if there are no outlets. Also returns null on the virtual clock, because a
/// rehearsal must not look like a session to the lab's systems. Throws Error when an outlet cannot
/// be opened.
std::unique_ptr<Listener> open_outlets(const Opening& opening);

}  // namespace dihaptic::session
