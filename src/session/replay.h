// Re-runs a session from the device input in its raw log, and compares every tick with the
// recording. All ticks from the first one on are needed: the comparison ends at the first missing
// tick.
#pragma once

#include <atomic>

#include "recording/log_health.h"
#include "session/session_run.h"

namespace dihaptic::session {

struct ReplayResult {
    int64_t ticks = 0;             ///< ticks compared
    int64_t different_ticks = 0;   ///< number of ticks in which any force or position differs
    double first_difference = -1;  ///< session time of the first difference [s]
    double elapsed = 0;
    bool interrupted = false;
    bool damaged = false;              ///< whether the log does not match the session's state
    std::string program;               ///< program that recorded the session, with its version
    std::vector<std::string> version;  ///< how the session's log differs from a log of this version
    std::vector<std::string> log;      ///< gaps in the log, in sentences
    std::vector<Problem> warnings;     ///< problems with the session's other files

    bool good() const { return different_ticks == 0 && !interrupted && !damaged; }
};

/// The results of a tick: forces, torques and poses. Two runs of the same session give the same
/// results bit for bit.
std::vector<double> outcome_of(const frame::Frame& frame);

/// Throws Error when the replay fails or when the session's frozen inputs were changed.
ReplayResult replay_session(const std::string& path, const std::atomic<bool>& stop,
                            const Progress& progress);

}  // namespace dihaptic::session
