// What is exported of a session is its whole recording: it has ended, and has one.
#pragma once

#include "recording/session.h"

namespace dihaptic::analysis {

/// Throws Error when the session has not ended, or has no recording any more.
void check_ended(const recording::SessionFolder& session, const recording::SessionInfo& info);

}  // namespace dihaptic::analysis
