// Reads recorded finger movements (CSV) as exported by a tracker; docs/files/movement.md
// describes the format.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/geometry.h"

namespace dihaptic::hand {

/// Directions of a recording's axes.
enum class RecordingAxes {
    world,  ///< x right, y away from the person, z up, the convention of Dihaptic
    y_up,   ///< x right, y up, z toward the person, the convention of many motion trackers
};
constexpr auto enum_names(RecordingAxes) {
    return std::array{"world", "y_up"};
}

struct Movement {
    std::string file;
    std::string checksum;  ///< of its text, as read (base/checksum.h)
    std::vector<std::string> fingers;
    /// Column names as in the file, for messages; position columns by finger and world axis.
    std::string time_column;
    std::vector<std::array<std::string, 3>> columns;
    struct Frame {
        double time = 0;         ///< on the file's clock [s]
        int line = 0;            ///< line in the file
        bool occluded = false;   ///< whether the tracker reported a lost marker
        std::vector<Vec3> p_WH;  ///< by finger, world axes; NaN where the file has no value [m]
    };
    std::vector<Frame> frames;

    /// Median of the times between frames [s].
    double frame_time() const;
};

/// Limits of a plausible recording; beyond them a time stamp, or its unit, is wrong.
constexpr double kLongestGap = 5;         // between two lines [s]
constexpr double kLongestMovement = 600;  // [s]
constexpr double kSlowestTracker = 10;    // [Hz]
constexpr double kFastestTracker = 5000;  // [Hz]

/// Reads a recording. Lines that cannot be read are errors in `diagnostics`, each with its line
/// number and remedy; values marked as missing are kept as NaN, for repair(). A file
/// exported by a tracker's own program may have markers other than the `fingers`, if these are
/// known.
Movement read_movement(const std::string& file, RecordingAxes axes, Diagnostics& diagnostics,
                       const std::vector<std::string>& fingers = {});

/// Keeps the named fingers, in that order. Each finger that the movement lacks is an error in
/// `diagnostics`; each further finger of the movement is a warning.
void choose_fingers(Movement& movement, const std::vector<std::string>& fingers,
                    Diagnostics& diagnostics);

}  // namespace dihaptic::hand
