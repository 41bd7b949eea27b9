// Leads a person through the calibration of a rig and, before a session, through the check that the
// calibration still holds. Forces stay off.
#pragma once

#include <functional>

#include "rig/calibration_run.h"

namespace dihaptic::rig {

/// What the person should do now, and the progress.
struct Guidance {
    int step = 0;  ///< from 1; 0: the person has only to wait
    int steps = 0;
    std::string text;
    double share = 0;      ///< that is measured, of what has to be
    std::string measured;  ///< in words; "" before anything is measured
};

/// Thrown by a guide when the person gives up.
struct GivenUp {};

/// The link between the program and the person. Called from the thread that leads, or from a thread
/// of a maker's library.
struct Guide {
    /// Called at the beginning of each step, and several times a second while something is
    /// measured.
    std::function<void(const Guidance& now)> show;
    /// Called in each tick: whether the person has said, since the last call, that the step is
    /// done.
    std::function<bool()> done;
};

/// Takes the samples of a calibration from the movements of a person or, on simulated devices, of a
/// simulated hand. Throws Error as make_devices() does, and when a device does not answer.
CalibrationInput lead_calibration(const Rig& rig, const Guide& guide);

/// Two endpoints that are held together, compared with their distance at calibration.
struct Together {
    /// Difference that is allowed beyond the calibration's own error [m]: a person does not hold
    /// fingers together twice in the same way.
    static constexpr double kMostApart = 1.5e-3;

    std::string first;   ///< finger
    std::string second;  ///< the other finger
    double apart = 0;    ///< distance of the endpoints now [m]
    double before = 0;   ///< their distance at calibration [m]
    bool agrees = false;

    /// The two distances, as a clause.
    std::string describe() const;
    /// The warning for endpoints that do not agree.
    Problem warning(const Rig& rig) const;
};

/// Whether there is something to check: several real devices, and a calibration during which their
/// endpoints were held together. `fingers`: those of the session.
bool can_check_together(const Rig& rig, const std::vector<std::string>& fingers);
/// Asks the person to hold each pair of endpoints together, and measures them for a second.
/// `devices`: active, and made by make_devices() for these fingers; activating them again could
/// reset them. Throws what `guide` throws, and Error when a device does not answer.
std::vector<Together> check_together(const Rig& rig, const std::vector<std::string>& fingers,
                                     devices::DeviceGroup& devices, const Guide& guide);

}  // namespace dihaptic::rig
