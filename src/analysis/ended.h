// Checks that a session can be exported, i.e. that it has ended and still has its recording.
#pragma once

#include "recording/session.h"

namespace dihaptic::analysis {

/// Throws Error when the session has not ended, or when its recording no longer exists.
void check_ended(const recording::SessionFolder& session, const recording::SessionInfo& info);

}  // namespace dihaptic::analysis
