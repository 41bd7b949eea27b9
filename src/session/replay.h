// Re-runs a session from the device input in its raw log, and compares every tick with the
// recording. It requires every tick from the first one on: at a missing tick, the comparison ends.
#pragma once

#include <atomic>

#include "recording/log_health.h"
#include "session/session_run.h"

namespace dihaptic::session {

struct ReplayResult {
    int64_t ticks = 0;             ///< ticks compared
    int64_t different_ticks = 0;   ///< ticks in which any force or position differs in any bit
    double first_difference = -1;  ///< session time [s]
    double elapsed = 0;
    bool interrupted = false;
    bool damaged = false;              ///< the log does not match the session's state
    std::string program;               ///< program that recorded the session, with its version
    std::vector<std::string> version;  ///< differences of its log from this version's logs
    std::vector<std::string> log;      ///< gaps in the log, in sentences
    std::vector<Problem> warnings;     ///< about the session's other files

    bool good() const { return different_ticks == 0 && !interrupted && !damaged; }
};

/// The results of a tick: forces, torques and poses. Two runs of one session give the same results
/// to the bit.
std::vector<double> outcome_of(const frame::Frame& frame);

/// Throws Error when this fails, or when the session's frozen inputs were changed.
ReplayResult replay_session(const std::string& path, const std::atomic<bool>& stop,
                            const Progress& progress);

}  // namespace dihaptic::session
