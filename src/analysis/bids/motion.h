// A session's motion in BIDS form: one tracking system for each finger and one for the objects,
// each with its channels.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "recording/raw_log.h"
#include "recording/session.h"

namespace dihaptic::analysis::bids {

struct Channel {
    std::string name;
    std::string component;  ///< x, y, z, quat_x, ...; "n/a" if none
    std::string type;       ///< type in Motion-BIDS; forces are MISC
    std::string point;      ///< tracked point
    std::string unit;
    std::string what;  ///< description
    std::function<double(const frame::Frame&)> value;
};

struct TrackingSystem {
    std::string name;   ///< name of the finger, or "objects"
    std::string model;  ///< model of the device that measured the motion
    std::vector<Channel> channels;
    int points = 0;  ///< number of tracked points
};

/// Returns the fingers in the order of the log, then the objects. (Files are renamed in the reverse
/// order.) Objects are the bodies that can move in the frozen scene, or all bodies if the scene
/// cannot be read. Throws Error when two fingers have the same label.
std::vector<TrackingSystem> tracking_systems(const recording::SessionFolder& session,
                                             const recording::SessionInfo& info,
                                             const recording::LogHead& head);

/// Contents of channels.tsv, channels.json and motion.json.
std::string channels_tsv(const TrackingSystem& system, double tick);
std::string channels_json();
std::string motion_json(const TrackingSystem& system, const std::string& task,
                        const recording::SessionInfo& info, double tick, int64_t ticks);

/// Returns the BIDS label for a text: only its letters and digits.
std::string label(const std::string& text);

}  // namespace dihaptic::analysis::bids
