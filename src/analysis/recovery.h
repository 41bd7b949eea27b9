// Sessions that were killed, and sessions whose files were damaged: what can be had of them is made
// anew, and what is lost is said.
#pragma once

#include "analysis/session_report.h"

namespace dihaptic::analysis {

/// What became of a session that was left behind.
struct Recovery {
    SessionFigures figures;
    recording::SessionInfo info;
    bool had_ended = false;         ///< its files were there before
    std::vector<Problem> warnings;  ///< what was lost or changed, beside the log
};

/// Makes the files of a session that was killed, or anew those of one that has them, from its log
/// and what else there is. Throws Error when it cannot, or while the session runs.
Recovery recover_session(const recording::SessionFolder& folder,
                         const std::function<void(double)>& progress);

}  // namespace dihaptic::analysis
