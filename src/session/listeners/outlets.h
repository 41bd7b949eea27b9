// Sends event codes, handle positions and forces of a running session to a lab's other recording
// systems, and receives their triggers.
#pragma once

#include "session/listeners/listener.h"

namespace dihaptic::session {

/// Null without outlets, and on the virtual clock, because a rehearsal must not look like a
/// session. Throws Error when an outlet cannot be opened.
std::unique_ptr<Listener> open_outlets(const Opening& opening);

}  // namespace dihaptic::session
