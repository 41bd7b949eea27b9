// Finds gaps and errors in a tracker's data, and bridges them: missing frames, markers frozen at
// their last positions, isolated wild positions, jumps. The result is a smooth path at 1 kHz that a
// hand could follow.
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
    int finger = -1;  ///< -1: all fingers
    double start =
        0;  ///< on the file's clock: the last good frame before the fault, or the fault's first [s]
    double end =
        0;  ///< on the file's clock: the first good frame after the fault, or the fault's last [s]
    int line = 0;         ///< line in the file at which the fault starts
    double distance = 0;  ///< between the good frames on both sides; NaN at an end [m]
    std::string column;   ///< for a wild position: the file's column with the largest error
    double value = 0;     ///< error in that column [m]
    bool wrong_unit =
        false;  ///< whether the position is a thousandth of its neighbours', so probably in metres
};

/// The repaired movement, at its recorded position, with time from 0.
struct Path {
    static constexpr double kRate = 1000;  ///< samples per second [Hz]
    std::vector<std::string> fingers;
    std::vector<std::vector<Vec3>> p_WH;  ///< by finger, by sample [m]
    std::vector<char> bridged;  ///< by sample: whether some finger's position was not measured
    std::vector<Fault> faults;  ///< in order of time
    size_t size() const { return p_WH.empty() ? 0 : p_WH.front().size(); }
    double duration() const { return size() < 2 ? 0 : static_cast<double>(size() - 1) / kRate; }
    double bridged_share() const;
};

/// Thresholds for faults. A reaching hand is slower than kMaxSpeed between any two frames, with one
/// frame of slack for a tracker whose time stamps are late.
constexpr double kMaxSpeed = 1.5;  // [m/s]
constexpr double kBridgeSpeed =
    1.0;                             // bridges are widened until they are no faster than this [m/s]
constexpr double kSmoothing = 12.0;  // zero-phase low-pass of the repaired path [Hz]

Path repair(const Movement& movement);

/// A movement with a larger bridged fraction than this is more guess than measurement, and gets a
/// warning.
constexpr double kMuchBridged = 0.5;

/// Describes a fault for people: "0.412 to 0.624 s: index: frozen marker ...".
std::string describe(const Fault& fault, const std::vector<std::string>& fingers);

}  // namespace dihaptic::hand
