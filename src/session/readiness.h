// What a laboratory looks at before a session: devices, their calibration, displays, rights for
// real time, room on the disk. Nothing is opened for it.
#pragma once

#include <string>
#include <vector>

#include "session/plan.h"

namespace dihaptic::session {

/// What can be done about a finding.
enum class Remedy { none, calibrate, register_display, choose_folder, allow_real_time };

struct Finding {
    std::string what;   ///< e.g. "calibration"
    std::string found;  ///< in a sentence
    bool good = true;
    Remedy remedy = Remedy::none;
    std::string how;  ///< the remedy in a sentence; empty: none is needed
};

/// Bytes that a session of this plan writes in an hour, about: log and NWB file together, measured
/// with two fingers at 1 kHz.
double bytes_per_hour(const Plan& plan);

/// `out`: folder for the sessions. `today`: ISO 8601.
std::vector<Finding> readiness(const Plan& plan, const std::string& out, const std::string& today);

}  // namespace dihaptic::session
