// Recorded finger movements (CSV), as a tracker left them: docs/files.md describes the format.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/geometry.h"

namespace dihaptic::hand {

/// How the axes of a recording lie.
enum class RecordingAxes {
    world,  ///< x right, y away from the person, z up, as everywhere here
    y_up,   ///< x right, y up, z toward the person, as motion trackers often have it
};
constexpr auto enum_names(RecordingAxes) {
    return std::array{"world", "y_up"};
}

struct Movement {
    std::string file;
    std::vector<std::string> fingers;
    /// The file's columns, those of positions by finger and world axis: what messages call a value.
    std::string time_column;
    std::vector<std::array<std::string, 3>> columns;
    struct Frame {
        double time = 0;         ///< as in the file [s]
        int line = 0;            ///< of the file
        bool occluded = false;   ///< the tracker said that it had lost a marker
        std::vector<Vec3> p_WH;  ///< by finger, world axes; NaN where the file has none [m]
    };
    std::vector<Frame> frames;
};

/// A recording keeps to these. Beyond them a time stamp is wrong, or its unit.
constexpr double kLongestGap = 5;         // between two lines [s]
constexpr double kLongestMovement = 600;  // [s]
constexpr double kSlowestTracker = 10;    // [Hz]
constexpr double kFastestTracker = 5000;  // [Hz]

/// Reads a recording. Lines that no reader could make sense of are errors in `diagnostics`, each
/// with its line and remedy; cells without a number are kept as NaN, for repair.
Movement read_movement(const std::string& file, RecordingAxes axes, Diagnostics& diagnostics);

/// Keeps the fingers named, in that order. Those that the movement lacks are errors in
/// `diagnostics`, those that are left over warnings.
void choose_fingers(Movement& movement, const std::vector<std::string>& fingers,
                    Diagnostics& diagnostics);

}  // namespace dihaptic::hand
