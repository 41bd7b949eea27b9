// Records a session: runs a plan, makes all files of the session, and says what is to be told of
// it.
#pragma once

#include <string>
#include <vector>

#include "analysis/session_report.h"
#include "session/session_run.h"

namespace dihaptic::session {

/// A session that is over, with all of its files.
struct Recorded : RunResult {
    analysis::SessionFigures figures;
    /// What whoever ran the session is to be told, with remedies: a line each, which begins with
    /// WARNING or note.
    std::vector<std::string> notes;

    /// Whether the session came to its end, and what was felt is what was planned.
    bool good() const { return !interrupted && !figures.failed(); }
};

/// Gets the share of the session's files that is made, from 0 on, and the session's folder.
using Finishing = std::function<void(const std::string& folder, double share)>;

/// Runs a session as run_session() does, and makes its files. Throws Error when it cannot; what was
/// recorded until then stays and can be recovered.
Recorded record(const Plan& plan, RunOptions options, const std::atomic<bool>& stop,
                const Progress& running = {}, const Finishing& finishing = {},
                std::unique_ptr<devices::DeviceGroup> devices = nullptr);

}  // namespace dihaptic::session
