// Guides a person through the calibration of a rig and, before a session, through the check that
// the calibration is still valid. Forces stay off.
#pragma once

#include <functional>

#include "rig/calibration_run.h"

namespace dihaptic::rig {

/// The person's present task, and the progress.
struct Guidance {
    int step = 0;  ///< from 1; 0: the person only has to wait
    int steps = 0;
    std::string text;
    double share = 0;      ///< measured fraction of the required samples
    std::string measured;  ///< in words; "" before anything is measured
};

/// Thrown by a guide when the person cancels.
struct GivenUp {};

/// The link between the program and the person. Called from the guiding thread, or from a thread
/// of a manufacturer's library.
struct Guide {
    /// Called at the start of each step, and several times a second during
    /// measurements.
    std::function<void(const Guidance& now)> show;
    /// Called in each tick: whether the person has reported, since the last call, that the step is
    /// done.
    std::function<bool()> done;
};

/// Takes the samples of a calibration from the movements of a person or, on simulated devices, of a
/// simulated hand. Throws Error like make_devices(), and if a device does not answer.
CalibrationInput lead_calibration(const Rig& rig, const Guide& guide);

/// The distance of two endpoints held together, and that at calibration.
struct Together {
    /// Difference allowed beyond the calibration's own error [m], because a person does not hold
    /// fingers together in the same way twice.
    static constexpr double kMostApart = 1.5e-3;

    std::string first;   ///< finger
    std::string second;  ///< the other finger
    double apart = 0;    ///< distance of the endpoints now [m]
    double before = 0;   ///< their distance at calibration [m]
    bool agrees = false;

    /// The two distances, as a clause.
    std::string describe() const;
    /// The warning for disagreeing endpoints.
    Problem warning(const Rig& rig) const;
};

/// Whether a check is possible: it needs several real devices, and a calibration in which their
/// endpoints were held together. `fingers`: those of the session.
bool can_check_together(const Rig& rig, const std::vector<std::string>& fingers);
/// Asks the person to hold each pair of endpoints together, and measures them for a second.
/// `devices`: active, and made by make_devices() for these fingers; another activation could
/// reset them. Passes on exceptions of `guide`; throws Error if a device does not answer.
std::vector<Together> check_together(const Rig& rig, const std::vector<std::string>& fingers,
                                     devices::DeviceGroup& devices, const Guide& guide);

}  // namespace dihaptic::rig
