// Guides a person through the calibration of a rig and, before a session, through the check that
// the calibration is still valid. Forces stay off throughout.
#pragma once

#include <functional>

#include "rig/calibration_run.h"

namespace dihaptic::rig {

/// What the person has to do now, and the progress so far.
struct Guidance {
    int step = 0;  ///< number of the step, counted from 1; 0 if the person only has to wait
    int steps = 0;
    std::string text;
    double share = 0;      ///< fraction of the required samples taken so far
    std::string measured;  ///< what has been measured, in words; "" if nothing has been yet
};

/// Thrown by a guide when the person cancels.
struct GivenUp {};

/// How the program communicates with the person. Called from the guiding thread, or from a thread
/// of a manufacturer's library.
struct Guide {
    /// Called at the start of each step, and several times per second while measuring.
    std::function<void(const Guidance& now)> show;
    /// Called in each tick. Returns whether, since the last call, the person has reported that the
    /// step is done.
    std::function<bool()> done;
};

/// Takes the samples for a calibration while a person or, on simulated devices, a simulated hand
/// moves the devices. Throws Error in the same cases as make_devices(), and if a device does not
/// answer.
CalibrationInput lead_calibration(const Rig& rig, const Guide& guide);

/// The distance between two endpoints held together, and their distance at calibration.
struct Together {
    /// Difference allowed in addition to the calibration's own error [m], because a person does not
    /// hold fingers together in exactly the same way twice.
    static constexpr double kMostApart = 1.5e-3;

    std::string first;   ///< finger
    std::string second;  ///< the other finger
    double apart = 0;    ///< present distance between the endpoints [m]
    double before = 0;   ///< distance between the endpoints at calibration [m]
    bool agrees = false;

    /// The two distances in words, as a clause.
    std::string describe() const;
    /// The warning that is given if the endpoints do not agree.
    Problem warning(const Rig& rig) const;
};

/// Whether a check is possible. This requires several real devices and a calibration in which their
/// endpoints were held together. `fingers` are the session's fingers.
bool can_check_together(const Rig& rig, const std::vector<std::string>& fingers);
/// Asks the person to hold each pair of endpoints together, and measures their distance for a
/// second. `devices` must be active, and made by make_devices() for these fingers, because another
/// activation could reset them. Passes on exceptions from `guide`; throws Error if a device does
/// not answer.
std::vector<Together> check_together(const Rig& rig, const std::vector<std::string>& fingers,
                                     devices::DeviceGroup& devices, const Guide& guide);

}  // namespace dihaptic::rig
