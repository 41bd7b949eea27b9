// Re-runs a session from the device input in its raw log, and compares every tick with what was
// recorded. It needs every tick from the first one: where one is missing, the comparison ends.
#pragma once

#include <atomic>

#include "recording/log_health.h"
#include "session/session_run.h"

namespace dihaptic::session {

struct ReplayResult {
    int64_t ticks = 0;             ///< compared
    int64_t different_ticks = 0;   ///< any force or position that differs in any bit
    double first_difference = -1;  ///< session time [s]
    double elapsed = 0;
    bool interrupted = false;
    bool damaged = false;              ///< the log is not what the session's state says
    std::string program;               ///< that recorded the session, and its version
    std::vector<std::string> version;  ///< how its log differs from those of this version
    std::vector<std::string> log;      ///< what is missing of it, in sentences
    std::vector<Problem> warnings;     ///< about the session's other files

    bool good() const { return different_ticks == 0 && !interrupted && !damaged; }
};

/// What a tick computed: forces, torques and poses. Of two runs of one session they are the same to
/// the bit.
std::vector<double> outcome_of(const frame::Frame& frame);

/// Throws Error when it cannot, or when the session's frozen inputs were changed.
ReplayResult replay_session(const std::string& path, const std::atomic<bool>& stop,
                            const Progress& progress);

}  // namespace dihaptic::session
