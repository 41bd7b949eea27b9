// Finds what a tracker lost, and bridges it: missing frames, markers that froze where they were
// last seen, single wild positions, jumps. What remains is a smooth path at 1 kHz that a hand could
// follow.
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
    int finger = -1;          ///< -1: all
    double start = 0;         ///< file's time of the last good frame before it, or its own [s]
    double end = 0;           ///< file's time of the first good frame after it, or its own [s]
    int line = 0;             ///< of the file, where it begins
    double distance = 0;      ///< between the good frames on both sides; NaN at an end [m]
    std::string column;       ///< of a wild position: where it is furthest off, as in the file
    double value = 0;         ///< ... and by how much [m]
    bool wrong_unit = false;  ///< the position is a thousandth of its neighbours': likely in metres
};

/// The repaired movement, in the recording's own place, time from 0.
struct Path {
    static constexpr double kRate = 1000;  ///< samples per second [Hz]
    std::vector<std::string> fingers;
    std::vector<std::vector<Vec3>> p_WH;  ///< by finger, by sample [m]
    std::vector<char> bridged;            ///< by sample: some finger's position is not measured
    std::vector<Fault> faults;            ///< in order of time
    size_t size() const { return p_WH.empty() ? 0 : p_WH.front().size(); }
    double duration() const { return size() < 2 ? 0 : static_cast<double>(size() - 1) / kRate; }
    double bridged_share() const;
};

/// Faults are judged by these. A hand that reaches is slower than kMaxSpeed between any two frames,
/// one frame of slack given to a tracker that stamps late.
constexpr double kMaxSpeed = 1.5;     // [m/s]
constexpr double kBridgeSpeed = 1.0;  // a bridge is widened until it is crossed no faster [m/s]
constexpr double kSmoothing = 12.0;   // zero-phase low-pass of the repaired path [Hz]

Path repair(const Movement& movement);

/// Above this share a movement is more guessed than measured: worth a warning.
constexpr double kMuchBridged = 0.5;

/// "0.412 to 0.624 s: index: frozen marker ...": for people.
std::string describe(const Fault& fault, const std::vector<std::string>& fingers);

}  // namespace dihaptic::hand
