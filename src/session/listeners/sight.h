// Shows the session to a simulated person and passes on the keys that this person presses.
#pragma once

#include "session/listeners/listener.h"

namespace dihaptic::session {

/// Returns null if the plan's hand does not react to what it sees.
std::unique_ptr<Listener> show_to_person(const Opening& opening);

}  // namespace dihaptic::session
