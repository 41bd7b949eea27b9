// Plays a task's sounds (src/sound).
#pragma once

#include "session/listeners/listener.h"

namespace dihaptic::session {

/// Returns null if the session plays no sounds. Throws Error when sounds cannot be played.
std::unique_ptr<Listener> play_sounds(const Opening& opening);

}  // namespace dihaptic::session
