// What a laboratory checks before a session: devices, their calibration, displays, permissions for
// real-time scheduling, disk space. No device is opened.
#pragma once

#include <string>
#include <vector>

#include "session/plan.h"

namespace dihaptic::session {

/// What can be done about a finding.
enum class Remedy { none, calibrate, register_display, choose_folder, allow_real_time };

struct Finding {
    std::string what;   ///< e.g. "calibration"
    std::string found;  ///< the finding, in a sentence
    bool good = true;
    Remedy remedy = Remedy::none;
    std::string how;  ///< the remedy, in a sentence; empty if none is needed
};

/// Approximate number of bytes that a session writes per hour, as measured with two fingers at 1
/// kHz: the log and the NWB file together. `tick` is the length of a tick [s].
double bytes_per_hour(size_t fingers, double tick);
double bytes_per_hour(const Plan& plan);

/// Checks whether the disk has room for sessions in `folder`, which need not exist yet.
Finding disk(const std::string& folder, double bytes_per_hour);

/// `out` is the folder for the sessions. `today` is the current date (ISO 8601).
std::vector<Finding> readiness(const Plan& plan, const std::string& out, const std::string& today);

}  // namespace dihaptic::session
