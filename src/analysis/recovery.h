// Recovers sessions that were killed or whose files were damaged: makes anew what can be made, and
// reports what is lost.
#pragma once

#include "analysis/session_report.h"

namespace dihaptic::analysis {

/// Result of recovering a session.
struct Recovery {
    SessionFigures figures;
    recording::SessionInfo info;
    bool had_ended = false;         ///< the session had ended, and had its files already
    std::vector<Problem> warnings;  ///< what was lost or changed, apart from the log
};

/// Makes the files of a session, or makes them anew if it has them, from its log and whatever else
/// is left. Throws Error when it cannot, or while the session runs.
Recovery recover_session(const recording::SessionFolder& folder,
                         const std::function<void(double)>& progress);

}  // namespace dihaptic::analysis
