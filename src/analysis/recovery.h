// Recovers sessions that were killed or whose files were damaged: rebuilds files where possible,
// and reports what was lost.
#pragma once

#include "analysis/session_report.h"

namespace dihaptic::analysis {

/// The result of recovering a session.
struct Recovery {
    SessionFigures figures;
    recording::SessionInfo info;
    bool had_ended = false;         ///< whether the session had ended and already had its files
    std::vector<Problem> warnings;  ///< losses and changes, except those in the log
};

/// Creates or rebuilds a session's files from its log and the remaining files. Throws Error when
/// this fails, or when the session is still running.
Recovery recover_session(const recording::SessionFolder& folder,
                         const std::function<void(double)>& progress);

}  // namespace dihaptic::analysis
