// Records a session: runs a plan, writes all files of the session, and collects messages about it.
#pragma once

#include <string>
#include <vector>

#include "analysis/session_report.h"
#include "session/session_run.h"

namespace dihaptic::session {

/// A finished session whose files are complete.
struct Recorded : RunResult {
    analysis::SessionFigures figures;
    /// Messages to the operator, with remedies. Each is a single line that starts with WARNING or
    /// note.
    std::vector<std::string> notes;

    /// Whether the session was completed and the forces felt were as planned.
    bool good() const { return !interrupted && !figures.failed(); }
};

/// Called while the session's files are being written, with the session's folder and the fraction
/// of the files that is complete, starting from 0.
using Finishing = std::function<void(const std::string& folder, double share)>;

/// Runs a session like run_session(), then writes its files. Throws Error when this fails; the data
/// recorded until then remain and can be recovered.
Recorded record(const Plan& plan, RunOptions options, const std::atomic<bool>& stop,
                const Progress& running = {}, const Finishing& finishing = {},
                std::unique_ptr<devices::DeviceGroup> devices = nullptr);

}  // namespace dihaptic::session
