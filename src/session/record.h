// Records a session: runs a plan, makes all files of the session, and collects the messages about
// it.
#pragma once

#include <string>
#include <vector>

#include "analysis/session_report.h"
#include "session/session_run.h"

namespace dihaptic::session {

/// A finished session, with all of its files.
struct Recorded : RunResult {
    analysis::SessionFigures figures;
    /// Messages to the operator, with remedies: one line each, which starts with WARNING or note.
    std::vector<std::string> notes;

    /// Whether the session was completed, and the felt forces were as planned.
    bool good() const { return !interrupted && !figures.failed(); }
};

/// Receives the share of the session's files that is complete, from 0 on, and the session's folder.
using Finishing = std::function<void(const std::string& folder, double share)>;

/// Runs a session like run_session(), and makes its files. Throws Error when this fails; data
/// recorded until then remain and can be recovered.
Recorded record(const Plan& plan, RunOptions options, const std::atomic<bool>& stop,
                const Progress& running = {}, const Finishing& finishing = {},
                std::unique_ptr<devices::DeviceGroup> devices = nullptr);

}  // namespace dihaptic::session
