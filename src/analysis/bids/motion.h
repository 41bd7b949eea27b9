// Motion of a session as BIDS has it: tracking systems, one for each finger and one for the
// objects, each with its channels.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "recording/raw_log.h"
#include "recording/session.h"

namespace dihaptic::analysis::bids {

struct Channel {
    std::string name;
    std::string component;  ///< x, y, z, quat_x, ...; n/a
    std::string type;       ///< as Motion-BIDS has them; forces are MISC
    std::string point;      ///< that is tracked
    std::string unit;
    std::string what;  ///< it is
    std::function<double(const servo::Frame&)> value;
};

struct TrackingSystem {
    std::string name;   ///< of the finger, or "objects"
    std::string model;  ///< of what measured it
    std::vector<Channel> channels;
    int points = 0;  ///< tracked
};

/// Fingers in the log's order, then the objects; files get their names in the opposite order.
/// Objects: bodies that can move, by the frozen scene; all bodies where that cannot be read.
/// Throws Error when a finger's label is another's.
std::vector<TrackingSystem> tracking_systems(const recording::SessionFolder& session,
                                             const recording::SessionInfo& info,
                                             const recording::LogHead& head);

/// channels.tsv, channels.json and motion.json.
std::string channels_tsv(const TrackingSystem& system, double tick);
std::string channels_json();
std::string motion_json(const TrackingSystem& system, const std::string& task,
                        const recording::SessionInfo& info, double tick, int64_t ticks);

/// Labels of BIDS have letters and digits only.
std::string label(const std::string& text);

}  // namespace dihaptic::analysis::bids
