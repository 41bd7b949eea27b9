// Finds gaps and errors in a tracker's data and bridges them: missing frames, markers frozen at
// their last position, isolated wild positions, and jumps. The result is a smooth path at 1 kHz
// that a hand could follow.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "hand/movement.h"

namespace dihaptic::hand {

enum class FaultKind { missing_frames, missing_marker, frozen_marker, wild_position, jump };
constexpr auto enum_names(FaultKind) {
    return std::array{"missing frames", "missing marker", "frozen marker", "wild position", "jump"};
}

struct Fault {
    FaultKind kind = FaultKind::missing_frames;
    int finger = -1;      ///< -1 for all fingers
    double start = 0;     ///< on the file's clock: last good frame before the fault or, if there is
                          ///< none, first frame of the fault [s]
    double end = 0;       ///< on the file's clock: first good frame after the fault or, if there is
                          ///< none, last frame of the fault [s]
    int line = 0;         ///< line in the file where the fault starts
    double distance = 0;  ///< distance between the good frames on both sides; NaN at either end of
                          ///< the file [m]
    std::string column;   ///< for a wild position: the column of the file with the largest error
    double value = 0;     ///< error in that column [m]
    bool wrong_unit =
        false;  ///< whether the position is a thousandth of its neighbours, so probably in metres
};

/// The repaired movement, at the recorded position, with time starting from 0.
struct Path {
    static constexpr double kRate = 1000;  ///< sampling rate [Hz]
    std::vector<std::string> fingers;
    std::vector<std::vector<Vec3>> p_WH;  ///< indexed by finger, then by sample [m]
    std::vector<char> bridged;  ///< for each sample: whether any finger's position was not measured
    std::vector<Fault> faults;  ///< in chronological order
    size_t size() const { return p_WH.empty() ? 0 : p_WH.front().size(); }
    double duration() const { return size() < 2 ? 0 : static_cast<double>(size() - 1) / kRate; }
    double bridged_share() const;
};

/// Thresholds for faults. A reaching hand moves more slowly than kMaxSpeed between any two frames,
/// with a tolerance of one frame for a tracker whose time stamps are late.
constexpr double kMaxSpeed = 1.5;     // [m/s]
constexpr double kBridgeSpeed = 1.0;  // bridges are widened until their speed is at most this [m/s]
constexpr double kSmoothing = 12.0;   // cut-off of the zero-phase low-pass filter for the path [Hz]

Path repair(const Movement& movement);

/// If a larger fraction of a movement is bridged, it is more guess than measurement and gets a
/// warning.
constexpr double kMuchBridged = 0.5;

/// Describes a fault in words: "0.412 to 0.624 s: index: frozen marker ...".
std::string describe(const Fault& fault, const std::vector<std::string>& fingers);

}  // namespace dihaptic::hand
