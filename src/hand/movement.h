// Reads recorded finger movements (CSV) as exported by trackers. The format is described in
// docs/files/movement.md.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/geometry.h"

namespace dihaptic::hand {

/// Directions of the axes of a recording.
enum class RecordingAxes {
    world,  ///< x right, y away from the person, z up: the Dihaptic convention
    y_up,   ///< x right, y up, z towards the person: the convention of many motion trackers
};
constexpr auto enum_names(RecordingAxes) {
    return std::array{"world", "y_up"};
}

struct Movement {
    std::string file;
    std::string checksum;  ///< checksum of the text as read (base/checksum.h)
    std::vector<std::string> fingers;
    /// Column names as in the file, for messages. Position columns are indexed by finger and world
    /// axis.
    std::string time_column;
    std::vector<std::array<std::string, 3>> columns;
    struct Frame {
        double time = 0;         ///< time on the file's clock [s]
        int line = 0;            ///< line number in the file
        bool occluded = false;   ///< whether the tracker reported a lost marker
        std::vector<Vec3> p_WH;  ///< one per finger, in world axes; NaN where the file has no value
                                 ///< [m]
    };
    std::vector<Frame> frames;

    /// Median time between frames [s].
    double frame_time() const;
};

/// Limits of a plausible recording. If they are exceeded, a time stamp or its unit is wrong.
constexpr double kLongestGap = 5;         // between two lines [s]
constexpr double kLongestMovement = 600;  // [s]
constexpr double kSlowestTracker = 10;    // [Hz]
constexpr double kFastestTracker = 5000;  // [Hz]

/// Reads a recording. Lines that cannot be read are reported as errors in `diagnostics`, each with
/// its line number and a remedy; values marked as missing are stored as NaN, for repair(). If the
/// `fingers` are known, a file exported by a tracker's own program may contain other markers as
/// well.
Movement read_movement(const std::string& file, RecordingAxes axes, Diagnostics& diagnostics,
                       const std::vector<std::string>& fingers = {});

/// Keeps the named fingers, in the given order. Each finger that is missing from the movement is
/// reported in `diagnostics` as an error, and each superfluous finger as a warning.
void choose_fingers(Movement& movement, const std::vector<std::string>& fingers,
                    Diagnostics& diagnostics);

}  // namespace dihaptic::hand
