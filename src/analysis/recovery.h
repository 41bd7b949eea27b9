// Recovers sessions that were killed or whose files were damaged: rebuilds files where possible,
// and reports losses.
#pragma once

#include "analysis/session_report.h"

namespace dihaptic::analysis {

/// Result of recovering a session.
struct Recovery {
    SessionFigures figures;
    recording::SessionInfo info;
    bool had_ended = false;         ///< the session had ended, and already had its files
    std::vector<Problem> warnings;  ///< losses and changes, apart from the log
};

/// Makes or rebuilds the files of a session from its log and the remaining files. Throws Error when
/// this fails, or while the session runs.
Recovery recover_session(const recording::SessionFolder& folder,
                         const std::function<void(double)>& progress);

}  // namespace dihaptic::analysis
