// The points that a laboratory checks before a session: devices, their calibration, displays,
// rights for real time, disk space. No device is opened.
#pragma once

#include <string>
#include <vector>

#include "session/plan.h"

namespace dihaptic::session {

/// The remedy for a finding.
enum class Remedy { none, calibrate, register_display, choose_folder, allow_real_time };

struct Finding {
    std::string what;   ///< e.g. "calibration"
    std::string found;  ///< in a sentence
    bool good = true;
    Remedy remedy = Remedy::none;
    std::string how;  ///< the remedy in a sentence; empty: none needed
};

/// Approximate number of bytes that a session writes in an hour: log and NWB file together,
/// measured with two fingers at 1 kHz. `tick`: [s].
double bytes_per_hour(size_t fingers, double tick);
double bytes_per_hour(const Plan& plan);

/// Whether the disk has room for sessions in `folder`, which need not exist yet.
Finding disk(const std::string& folder, double bytes_per_hour);

/// `out`: folder for the sessions. `today`: ISO 8601.
std::vector<Finding> readiness(const Plan& plan, const std::string& out, const std::string& today);

}  // namespace dihaptic::session
